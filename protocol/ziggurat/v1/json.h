// SPDX-License-Identifier: MIT
#pragma once
// The JSON twin of the protocol's messages: protobuf's canonical JSON.

#include <google/protobuf/message.h>

#include <string>
#include <string_view>

namespace ziggurat::v1 {

/// Compact, in lowerCamelCase; fields without a value of their own are written all the same
/// (numbers 0, texts "", arrays []), so that a reader need not ask which there are. Absent
/// messages and members of a `oneof` stay absent.
std::string to_json(const google::protobuf::Message& message);

/// Replaces `message` by what the text says; unknown fields are ignored.
/// @return what is wrong with the text, empty if nothing; then `message` holds nothing of use
std::string from_json(std::string_view text, google::protobuf::Message& message);

}  // namespace ziggurat::v1
