#pragma once
// Messages as JSON.

#include <google/protobuf/message.h>

#include "recording/output_file.h"

namespace ziggurat::recording {

/// Writes the message as protobuf JSON, with the field names of the .proto, defaults written out and maps
/// sorted by key, to the end of the file's buffer, which it empties when it is large: text can take far more memory than
/// its message. @throws WriteError, also if the message has no JSON form
void write_json(const google::protobuf::Message& message, OutputFile& to);

}  // namespace ziggurat::recording
