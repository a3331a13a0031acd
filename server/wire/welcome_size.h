#pragma once
// Memory that clients need to decode a Welcome.

#include <cstddef>
#include <span>

#include "wire/messages.h"

namespace ziggurat::wire {

/// Clients refuse a Welcome that could take all memory (docs/protocol.md, H9). There is place for
/// what is not described: policies of each robot, and what was commanded before.
/// @param robots  of a session, into Layout::robots
bool are_decoded(const Run& run, std::span<const std::size_t> robots);
/// Likewise, of a director.
bool is_decoded(const scene::Director& director);

}  // namespace ziggurat::wire
