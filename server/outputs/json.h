// SPDX-License-Identifier: MIT
#pragma once
// Messages as JSON.

#include <google/protobuf/message.h>

#include "outputs/output_file.h"

namespace ziggurat::outputs {

/// Writes the message as protobuf JSON to the end of the file's buffer, and empties that when it is
/// large. Text can take far more memory than its message. Field names are those of the .proto,
/// defaults are written out, and maps are sorted by key.
/// @throws WriteError, also if the message has no JSON form
void write_json(const google::protobuf::Message& message, OutputFile& to);

}  // namespace ziggurat::outputs
