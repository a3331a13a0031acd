// SPDX-License-Identifier: MIT
#include "ziggurat/v1/json.h"

#include <google/protobuf/util/json_util.h>

#include <algorithm>

#include "ziggurat/v1/envelope.h"

namespace ziggurat::v1 {

using google::protobuf::StringPiece;

std::string to_json(const google::protobuf::Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.always_print_primitive_fields = true;
  std::string text;
  const auto status = google::protobuf::util::MessageToJsonString(message, &text, options);
  return status.ok() ? text : "{}";  // a message of unknown kind: never for valid UTF-8
}

std::string from_json(std::string_view text, google::protobuf::Message& message) {
  google::protobuf::util::JsonParseOptions options;
  options.ignore_unknown_fields = true;
  const auto status = google::protobuf::util::JsonStringToMessage(
      StringPiece(text.data(), text.size()), &message, options);
  if (status.ok()) return {};
  constexpr std::size_t enough = 300;  // bytes: it may quote the whole text
  const StringPiece why = status.message();
  if (why.empty()) return "not JSON";
  return valid_utf8(std::string_view(why.data(), std::min(why.size(), enough)));
}

}  // namespace ziggurat::v1
