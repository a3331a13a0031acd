// SPDX-License-Identifier: MIT
#pragma once
// A recording as files that other programs read.

#include <cstdint>
#include <functional>
#include <string>

#include "recording/replay/recording_file.h"

namespace ziggurat::replay {

/// Poses of each recorded state, with the columns of `--trace`.
/// @returns how many states were written
/// @throws RecordingError, outputs::WriteError
std::uint64_t export_csv(const RecordingFile& file, const std::string& out);

/// One line for each message: `{"topic": …, "time_s": …, "message": {…}}`, messages as protobuf's
/// JSON with the names of the .proto files.
/// @param is_wanted  whether a topic is; topics with types that this version does not know are not
/// @returns how many messages were written
/// @throws RecordingError, outputs::WriteError
std::uint64_t export_jsonl(const RecordingFile& file,
                           const std::function<bool(const std::string&)>& is_wanted,
                           const std::string& out);

}  // namespace ziggurat::replay
