// SPDX-License-Identifier: MIT
#pragma once
// A robot whose script runs against values that the test sets. A wrong value fails an assert of the
// script.

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>

#include "one_robot.h"
#include "script/controller.h"

namespace ziggurat::lua {

inline const std::string prelude = R"lua(
function init() end
function refused(pattern, f, ...)
  local ok, message = pcall(f, ...)
  assert(not ok, "was not refused")
  assert(message:find(pattern), message)
end
)lua";

class Devices : public ::testing::Test {
 protected:
  Devices() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::path(::testing::TempDir()) /
            (std::string("devices_") + test->name() + ".lua");
    robot_.set_id("robot");
  }
  ~Devices() override { std::filesystem::remove(path_); }

  /// Runs the chunk and its init().
  Failure start(const std::string& script) {
    std::ofstream(path_) << prelude << script;
    one_.emplace(robot_);
    controller_ = std::make_unique<Controller>(one_->robot(), ScriptOptions{path_});
    return controller_->start();
  }
  Failure step() {
    one_->sense();
    return controller_->step(++tick_);
  }
  Robot& robot() { return one_->robot(); }
  v1::Observation& seen() { return one_->seen; }     ///< what step() begins with
  v1::Command command() { return one_->command(); }  ///< what was set since the last call

  v1::RobotDescription robot_;  ///< that start() begins with

 private:
  std::filesystem::path path_;
  std::optional<OneRobot> one_;
  std::unique_ptr<Controller> controller_;
  std::uint64_t tick_ = 0;
};

#define EXPECT_RUNS(call)                          \
  do {                                             \
    const Failure failure = call;                  \
    EXPECT_FALSE(failure) << failure.value_or(""); \
  } while (false)

struct RadioUse {
  bool receives = false, sends = false;
};

inline void add_radio(v1::RobotDescription& robot, const char* id, RadioUse use) {
  v1::RadioDescription& radio = *robot.add_radios();
  radio.set_id(id);
  radio.set_receives(use.receives);
  radio.set_sends(use.sends);
}

/// Wheels and a turret, each with sensor and actuator.
inline void add_driving(v1::RobotDescription& robot) {
  robot.mutable_wheels()->set_axle_length(0.14);
  robot.mutable_wheels()->set_measures(true);
  robot.mutable_wheels()->set_drives(true);
  robot.mutable_turret()->set_measures(true);
  robot.mutable_turret()->set_drives(true);
}

}  // namespace ziggurat::lua
