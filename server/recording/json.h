#pragma once
// Messages of recording.proto as lines of JSON.

#include <google/protobuf/message.h>

#include <string>

namespace ziggurat::recording {

/// The message as protobuf JSON, with the field names of the .proto, defaults written out and maps
/// sorted by key. @throws WriteError if there is none
std::string to_json(const google::protobuf::Message& message);

}  // namespace ziggurat::recording
