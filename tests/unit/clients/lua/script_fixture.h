// SPDX-License-Identifier: MIT
#pragma once
// A robot with two joints whose script is written by the test.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "clients/one_robot.h"
#include "script/controller.h"
#include "temporary_folder.h"

namespace ziggurat::lua {

class ScriptTest : public ::testing::Test {
 protected:
  ScriptTest() {
    robot_.set_id("r0");
    for (const auto& [name, value] : {std::pair{"script", "main.lua"}, std::pair{"speed", "2"}}) {
      v1::Parameter& param = *robot_.add_params();
      param.set_name(name);
      param.set_value(value);
    }
    for (const char* id : {"both", "sensor"}) robot_.add_joint_sensors()->set_id(id);
    for (const char* id : {"both", "motor"}) robot_.add_joint_actuators()->set_id(id);
  }
  void write(const std::string& file, const std::string& text) {
    std::ofstream(folder_ / file) << text;
  }

  /// Runs the chunk and init(), which is empty unless the script has its own.
  Failure start(const std::string& script) {
    write(
        "main.lua",
        (script.find("function init") == std::string::npos ? "function init() end " : "") + script);
    options_.script = folder_ / "main.lua";
    controller_ = std::make_unique<Controller>(one_.emplace(robot_).robot(), options_);
    return controller_->start();
  }

  /// Log of a script of one line at its beginning; the failure's text if it fails.
  std::vector<std::string> logged(const std::string& script) {
    if (const Failure failure = start(script)) return {*failure};
    std::vector<std::string> lines;
    for (const LogLine& line : controller_->log().lines) lines.push_back(line.text);
    return lines;
  }

  Controller& controller() { return *controller_; }
  Joint& joint(std::size_t i) { return one_->robot().joints()[i]; }  ///< both, sensor, motor
  v1::Command command() { return one_->command(); }  ///< what was set since the last call
  void sense(int joint, double reading) {
    one_->seen.set_joint_readings(joint, reading);
    one_->sense();
  }
  const std::filesystem::path& folder() const { return folder_.path; }

  v1::RobotDescription robot_;  ///< that start() begins with
  ScriptOptions options_;

 private:
  TemporaryFolder folder_;
  std::optional<OneRobot> one_;
  std::unique_ptr<Controller> controller_;
};

using Lines = std::vector<std::string>;

}  // namespace ziggurat::lua
