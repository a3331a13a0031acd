#include "ziggurat/v1/cost.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <cstdint>
#include <optional>

namespace ziggurat::v1 {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;

namespace {

/// Takes a varint from the front; none if there is none.
std::optional<std::uint64_t> take_varint(std::string_view& bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes.size() && i < 10; ++i) {
    const auto byte = static_cast<unsigned char>(bytes[i]);
    value |= std::uint64_t{byte & 0x7FU} << (7 * i);
    if (byte >= 0x80) continue;
    bytes.remove_prefix(i + 1);
    return value;
  }
  return std::nullopt;
}

/// Takes the value of a field; its content if it has a length. None at the end of what can be read.
std::optional<std::string_view> take_value(std::string_view& bytes, unsigned wire_type) {
  std::uint64_t size = 0;
  switch (wire_type) {
    case 0:
      return take_varint(bytes) ? std::optional(std::string_view()) : std::nullopt;
    case 1:
      size = 8;
      break;
    case 2: {
      const auto length = take_varint(bytes);
      if (!length) return std::nullopt;
      size = *length;
      break;
    }
    case 5:
      size = 4;
      break;
    default:  // the ends of a group
      return std::string_view();
  }
  if (size > bytes.size()) return std::nullopt;
  const auto content = bytes.substr(0, static_cast<std::size_t>(size));
  bytes.remove_prefix(content.size());
  return content;
}

/// Whether numbers of a list take as many bytes in the message as in memory.
bool has_fixed_size(const FieldDescriptor& field) {
  switch (field.type()) {
    case FieldDescriptor::TYPE_DOUBLE:
    case FieldDescriptor::TYPE_FLOAT:
    case FieldDescriptor::TYPE_FIXED64:
    case FieldDescriptor::TYPE_FIXED32:
    case FieldDescriptor::TYPE_SFIXED64:
    case FieldDescriptor::TYPE_SFIXED32:
      return true;
    default:
      return false;
  }
}

}  // namespace

std::size_t count_fields(std::string_view bytes, const Descriptor& message, std::size_t most) {
  constexpr std::uint64_t largest_number = (1U << 29) - 1;
  std::size_t fields = 0;
  while (!bytes.empty() && fields <= most) {
    const auto tag = take_varint(bytes);
    if (!tag || *tag >> 3 > largest_number) break;
    const auto wire_type = static_cast<unsigned>(*tag & 7);
    const auto content = take_value(bytes, wire_type);
    if (!content) break;
    ++fields;
    const FieldDescriptor* field =
        wire_type == 2 ? message.FindFieldByNumber(static_cast<int>(*tag >> 3)) : nullptr;
    const bool is_message =
        field != nullptr && field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE;
    if (is_message) fields += count_fields(*content, *field->message_type(), most - std::min(most, fields));
    // Each byte may be a number of a list, which takes four bytes of memory or more. Text is looked at
    // character by character.
    const bool has_numbers = field != nullptr && field->is_packable() && !has_fixed_size(*field);
    const bool is_text = field != nullptr && field->type() == FieldDescriptor::TYPE_STRING;
    if (has_numbers || is_text) fields += content->size() / bytes_per_field;
  }
  return fields;
}

}  // namespace ziggurat::v1
