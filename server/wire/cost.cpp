#include "wire/cost.h"

#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {

std::size_t count_fields(std::string_view bytes) {
  return v1::count_fields(bytes, *v1::ClientMessage::descriptor(), most_fields);
}

std::size_t count_json_values(std::string_view text) {
  std::size_t values = 0;
  bool is_text = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char each = text[i];
    if (each == '"') is_text = !is_text;
    if (is_text && each == '\\') ++i;
    if (!is_text && (each == ',' || each == '[' || each == '{')) ++values;
  }
  return values;
}

}  // namespace ziggurat::wire
