#pragma once
// What the barrier knows of robots and sessions, for people and programs that ask.

#include <vector>

#include "network/barrier/barrier.h"
#include "network/report.h"
#include "wire/request.h"

namespace ziggurat::network {

/// Per robot of the layout.
std::vector<RobotStatus> robot_status(const Barrier& barrier);
/// Adds the sessions, and robots that are free or have left.
/// @param now  ages are measured up to then
void fill(const Barrier& barrier, Time now, wire::Status& status);

/// What the world needs most of the sessions that have these robots or directors.
/// @param ids  of one robot or director of each session; others mean nothing
Need need_of(const Barrier& barrier, const std::vector<std::string>& ids);

/// With the ids of their robots.
std::vector<world::Metric> named(const Barrier& barrier, const std::vector<wire::Metric>& metrics);
/// That were set at the tick in hand: in scene order, then those of directors.
std::vector<world::Metric> metrics_of_tick(const Barrier& barrier);

}  // namespace ziggurat::network
