// SPDX-License-Identifier: MIT
#include "wire/answer.h"

#include <string_view>

#include "ziggurat/v1/json.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {
namespace {

// Fields may come in any order and need not be in one piece: a number in front of the rest is
// enough.
constexpr char length_delimited = 2, varint = 0;
constexpr std::string_view text_before_number = R"({"response":{"id":")";

void append_varint(std::string& to, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) to += static_cast<char>(value | 0x80);
  to += static_cast<char>(value);
}

void append_tag(std::string& to, int field, char wire_type) {
  append_varint(to, static_cast<std::uint64_t>(field) << 3 | static_cast<unsigned>(wire_type));
}

}  // namespace

Answer::Answer(const v1::ServerMessage& message)
    : content_(message.response().SerializeAsString()) {}

std::string Answer::bytes(std::uint64_t request, Encoding encoding) {
  std::string bytes;
  if (encoding == Encoding::json) {
    if (text_.empty()) {
      v1::ServerMessage message;
      message.mutable_response()->ParseFromString(content_);
      text_ = v1::to_json(message).substr(text_before_number.size() + 1);  // without "0"
    }
    bytes.reserve(text_before_number.size() + 20 + text_.size());
    bytes += text_before_number;
    bytes += std::to_string(request);
    bytes += text_;
    return bytes;
  }
  std::string number;
  append_tag(number, v1::Response::kIdFieldNumber, varint);
  append_varint(number, request);
  bytes.reserve(12 + number.size() + content_.size());
  append_tag(bytes, v1::ServerMessage::kResponseFieldNumber, length_delimited);
  append_varint(bytes, number.size() + content_.size());
  bytes += number;
  bytes += content_;
  return bytes;
}

}  // namespace ziggurat::wire
