#pragma once
// A robot whose script runs against values of the test's. A script's fault fails its assert.

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

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
    robot_.id = "robot";
  }
  ~Devices() override { std::filesystem::remove(path_); }

  /// Runs the chunk and its init().
  Failure start(const std::string& script) {
    std::ofstream(path_) << prelude << script;
    controller_ = std::make_unique<Controller>(robot_, ControllerOptions{path_});
    return controller_->start();
  }
  Failure step() { return controller_->step(++tick_); }
  ScriptedRobot& robot() { return controller_->robot(); }

  ScriptedRobot robot_;  ///< that start() begins with

 private:
  std::filesystem::path path_;
  std::unique_ptr<Controller> controller_;
  std::uint64_t tick_ = 0;
};

#define EXPECT_RUNS(call)                          \
  do {                                             \
    const Failure failure = call;                  \
    EXPECT_FALSE(failure) << failure.value_or(""); \
  } while (false)

/// Wheels and a turret, each with sensor and actuator.
inline void add_driving(ScriptedRobot& robot) {
  Wheels& wheels = robot.wheels.emplace();
  wheels.axle_length = 0.14;
  wheels.has_sensor = wheels.has_actuator = true;
  Turret& turret = robot.turret.emplace();
  turret.has_encoder = turret.has_actuator = true;
}

}  // namespace ziggurat::lua
