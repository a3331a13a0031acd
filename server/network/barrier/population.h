// SPDX-License-Identifier: MIT
#pragma once
// Robots come and go, all together or some of them (docs/protocol.md, V6, V9, V13 and V14).

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "network/barrier/barrier.h"

namespace ziggurat::network {

/// The world is loaded, with the robots of the run's layout. Clients that wait for it are answered.
/// @param run     what it refers to must outlive the barrier
/// @param config  its deadlines, and whether reactions are kept: a scene may say both
void open(Barrier& barrier, const wire::Run& run, const Config& config);
/// Robots have come: those of the layout that were not known. The current tick does not wait for
/// them.
/// @param scripts  of them, as Run::scripts
/// @param readings   of the current tick, theirs included
void add_robots(Barrier& barrier, std::span<const std::string> scripts,
                const TickReadings& readings);
/// These robots have left the world.
/// @param why  a sentence for their sessions; empty: they are not told
void remove_robots(Barrier& barrier, std::span<const std::size_t> robots, const std::string& why);
/// The world has begun anew or gone back, without tick: what was commanded and is owed is void.
/// Robots that the layout has no more, or that are others now, are forgotten; these others come by
/// add_robots().
/// @param restart  its epoch is the barrier's to know
void restart(Barrier& barrier, wire::Restart restart);

}  // namespace ziggurat::network
