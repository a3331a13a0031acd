#pragma once
// Who is in a recorded world, from its topic /world: no world is built for it.

#include <string>
#include <vector>

#include "replay/recording_file.h"

namespace ziggurat::replay {

/// For each link of the largest world of the recording: `'ENTITY'`, or `'ENTITY', link 'LINK'`.
/// Empty if the topic was not recorded.
std::vector<std::string> link_names(const RecordingFile& file);

/// The name of a link, also if it is not known.
std::string name_of(const std::vector<std::string>& names, std::size_t link);

}  // namespace ziggurat::replay
