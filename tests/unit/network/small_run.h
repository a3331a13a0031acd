// SPDX-License-Identifier: MIT
#pragma once
// A run of a few robots, each with one hinge, for tests that need no scene.

#include <string>
#include <vector>

#include "scene/scene.h"
#include "wire/messages.h"
#include "world/commands.h"
#include "world/layout.h"

namespace ziggurat::network {

/// The tag payloads of a run without tags.
inline const std::vector<std::string> no_tags;

/// robot0 … robot<n-1>, each with joint "hinge", sensed by position and driven by velocity. Even
/// ones belong to the controller "lua", odd ones to "external".
class SmallRun {
 public:
  explicit SmallRun(std::size_t robots) {
    controllers_.resize(2);
    controllers_[0].id = "lua";
    controllers_[0].lua = true;
    controllers_[1].id = "external";
    while (layout_.robots.size() < robots) add_robot();
  }

  /// One more, behind all others.
  void add_robot() {
    const std::size_t i = layout_.robots.size();
    world::RobotLayout robot;
    robot.id = "robot" + std::to_string(i);
    robot.entity = i;
    robot.controller = i % 2;
    robot.params = {{"speed", std::to_string(i)}, {"script", "drive.lua"}};
    robot.joint_sensors = {i, 1};
    robot.joint_actuators = {i, 1};
    layout_.robots.push_back(robot);
    layout_.joint_sensors.push_back({.id = "hinge"});
    layout_.joint_actuators.push_back({.id = "hinge", .velocity = true, .max_impulse = 0.005});
  }

  wire::Run run() const {
    wire::Run run{layout_, controllers_, {}, 42, 100'000'000, 10, "0123456789abcdef", "0.1.0"};
    for (const auto& robot : layout_.robots) {
      run.scripts.push_back(robot.controller == 0 ? "/scenes/drive.lua" : "");
    }
    run.directors = directors;
    return run;
  }

  std::vector<scene::Director> directors;  ///< none at first

  world::Layout& layout() { return layout_; }

  /// Each reading of robot i is 100 * tick + i.
  world::Observations observations(std::uint64_t tick) const {
    world::Observations result;
    result.tick = tick;
    result.time_ns = static_cast<std::int64_t>(tick) * 100'000'000;
    for (std::size_t i = 0; i < layout_.joint_sensors.size(); ++i) {
      result.joint_readings.push_back(100.0 * static_cast<double>(tick) + static_cast<double>(i));
    }
    return result;
  }

  world::Commands commands() const {
    world::Commands result;
    result.joint_targets.resize(layout_.joint_actuators.size());
    return result;
  }

 private:
  world::Layout layout_;
  std::vector<scene::Controller> controllers_;
};

}  // namespace ziggurat::network
