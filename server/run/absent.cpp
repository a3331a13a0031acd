// SPDX-License-Identifier: MIT
#include "run/absent.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "processes/controllers.h"

namespace ziggurat::run {

bool is_required(const network::RobotStatus& robot, bool gathered) {
  return !gathered || robot.deadline.action == scene::DeadlineAction::wait;
}

std::vector<std::size_t> absent_robots(const std::vector<network::RobotStatus>& robots,
                                       bool gathered) {
  std::vector<std::size_t> absent;
  for (std::size_t r = 0; r < robots.size(); ++r) {
    const bool is_free = robots[r].membership == network::RobotStatus::Membership::free;
    if (is_free && is_required(robots[r], gathered)) absent.push_back(r);
  }
  return absent;
}

std::vector<std::string> absent_directors(const std::vector<network::DirectorStatus>& directors,
                                          bool gathered) {
  std::vector<std::string> lost;
  for (const network::DirectorStatus& each : directors) {
    const bool is_gone = !each.is_held && !each.has_left;
    if (is_gone && (!gathered || each.waits)) lost.push_back(each.id);
  }
  return lost;
}

std::string by_controller(const supervision::World& world, const std::vector<std::size_t>& robots) {
  const world::Layout& layout = world.simulation.layout();
  std::string text;
  for (std::size_t c = 0; c < world.scene.controllers.size(); ++c) {
    std::vector<std::size_t> controlled;
    std::ranges::copy_if(robots, std::back_inserter(controlled),
                         [&](std::size_t robot) { return layout.robots[robot].controller == c; });
    if (controlled.empty()) continue;
    text += fmt::format("{}{} (controller '{}')", text.empty() ? "" : ", ",
                        processes::names_of(controlled, layout), world.scene.controllers[c].id);
  }
  return text;
}

}  // namespace ziggurat::run
