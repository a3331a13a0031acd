// SPDX-License-Identifier: MIT
#pragma once
// The log of a recorded run.

#include <string>
#include <vector>

#include "recording/replay/recording_file.h"

namespace ziggurat::replay {

/// Sentences on what may make a controller that begins anew command something else: the restarts
/// and missed deadlines that the log tells. Empty: it tells none. @throws RecordingError
std::vector<std::string> causes_of_commands(const RecordingFile& file);

}  // namespace ziggurat::replay
