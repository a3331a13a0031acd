// SPDX-License-Identifier: MIT
#pragma once
// Status of robots and sessions, for users and programs that ask for it.

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

/// Greatest need of the sessions that have these robots or directors.
/// @param ids  one robot or director of each session; unknown ids are ignored
Need need_of(const Barrier& barrier, const std::vector<std::string>& ids);

/// With the ids of their robots.
std::vector<world::Metric> named(const Barrier& barrier, const std::vector<wire::Metric>& metrics);
/// Metrics that were set at the current tick: in scene order, then those of directors.
std::vector<world::Metric> metrics_of_tick(const Barrier& barrier);

}  // namespace ziggurat::network
