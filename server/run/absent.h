// SPDX-License-Identifier: MIT
#pragma once
// Controllers and directors that are not there: whom the run can't go on without.

#include <cstddef>
#include <string>
#include <vector>

#include "network/server.h"
#include "supervision/world.h"

namespace ziggurat::run {

/// Whether the run cannot continue without the robot's controller: before the first tick always,
/// later if its deadline policy is to wait.
/// @param gathered  every robot and director was there
bool is_required(const network::RobotStatus& robot, bool gathered);

/// Robots without session that the run can't go on without.
/// @returns places in the layout, in its order
std::vector<std::size_t> absent_robots(const std::vector<network::RobotStatus>& robots,
                                       bool gathered);

/// Directors without session that the run can't go on without.
/// @returns their ids
std::vector<std::string> absent_directors(const std::vector<network::DirectorStatus>& directors,
                                          bool gathered);

/// A list of robots by their controllers: "r0, r1 (controller 'swing'), r7 (controller 'lift')".
std::string by_controller(const supervision::World& world, const std::vector<std::size_t>& robots);

}  // namespace ziggurat::run
