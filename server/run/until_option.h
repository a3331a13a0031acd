#pragma once
// --until TICK of commands that repeat a recording.

#include <cstdint>

#include "recording/replay/recording_file.h"

namespace ziggurat::run {

/// Reads the recording as far as that tick. One that is damaged before it is told later.
/// @throws text::UsageError if it has no state with this tick
void check_until(const replay::RecordingFile& file, std::uint64_t until);

}  // namespace ziggurat::run
