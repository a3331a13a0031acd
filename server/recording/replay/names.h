// SPDX-License-Identifier: MIT
#pragma once
// Who is in a recorded world, from its topic /world: no world is built for it.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "recording/replay/recording_file.h"

namespace ziggurat::v1 {
class World;
}

namespace ziggurat::replay {

/// For each link of the largest world of the recording: `'ENTITY'`, or `'ENTITY', link 'LINK'`.
/// Empty if the topic was not recorded. @throws RecordingError if a message of it is damaged, or
/// has longer names than any run
std::vector<std::string> link_names(const RecordingFile& file);

/// The most that the names of a world may have with each link's entity beside it: each entity is
/// named as often as it has links [bytes].
inline constexpr std::size_t most_name_bytes = std::size_t{128} << 20;

/// Fault of a world with more of them.
std::optional<std::string> fault_of_names(const v1::World& world);

/// The name of a link, also if it is not known.
std::string name_of(const std::vector<std::string>& names, std::size_t link);

}  // namespace ziggurat::replay
