#pragma once
// A robot with two joints whose script is written by the test.

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "script/controller.h"

namespace ziggurat::lua {

class ScriptTest : public ::testing::Test {
 protected:
  ScriptTest() {
    std::string folder = (std::filesystem::temp_directory_path() / "lua-XXXXXX").string();
    folder_ = ::mkdtemp(folder.data());
    robot_.id = "r0";
    robot_.params = {{"script", "main.lua"}, {"speed", "2"}};
    robot_.joints = {{.id = "both", .has_encoder = true, .has_motor = true},
                     {.id = "sensor", .has_encoder = true},
                     {.id = "motor", .has_motor = true}};
  }
  ~ScriptTest() override {
    controller_.reset();
    std::filesystem::remove_all(folder_);
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
    controller_ = std::make_unique<Controller>(robot_, options_);
    return controller_->start();
  }

  /// What the script of one line logs at its beginning; the failure's text if it fails.
  std::vector<std::string> logged(const std::string& script) {
    if (const Failure failure = start(script)) return {*failure};
    std::vector<std::string> lines;
    for (const LogLine& line : controller_->robot().log.lines) lines.push_back(line.text);
    return lines;
  }

  Controller& controller() { return *controller_; }
  Joint& joint(std::size_t i) { return controller_->robot().joints[i]; }
  const std::filesystem::path& folder() const { return folder_; }

  ScriptedRobot robot_;  ///< that start() begins with
  ControllerOptions options_;

 private:
  std::filesystem::path folder_;
  std::unique_ptr<Controller> controller_;
};

using Lines = std::vector<std::string>;

}  // namespace ziggurat::lua
