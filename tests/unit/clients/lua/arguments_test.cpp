// SPDX-License-Identifier: MIT
// Devices' functions check what they are given, and can be kept.

#include <algorithm>
#include <limits>

#include "script_fixture.h"

namespace ziggurat::lua {
namespace {

class Arguments : public ScriptTest {};

TEST_F(Arguments, BothNumberSubtypesAreNumbers) {
  ASSERT_EQ(start("robot.joints.both.set_target(2) robot.joints.motor.set_target(0.5)"),
            std::nullopt);
  EXPECT_EQ(joint(0).target(), 2);
  EXPECT_EQ(joint(2).target(), 0.5);
  EXPECT_EQ(command().joint_targets_size(), 2);
}

TEST_F(Arguments, WrongArgumentsAreErrorsThatScriptsCanCatch) {
  const std::string script = R"(
    for _, argument in ipairs{{}, {1, 2}, {"1"}, {"x"}, {true}, {{}}, {1/0}, {-1/0}, {0/0}} do
      local ok, message = pcall(robot.joints.both.set_target, table.unpack(argument))
      log(ok, " ", (message:gsub("^.*set_target", "set_target")))
    end
    local ok, message = pcall(robot.joints.both.set_target, nil)
    log(ok, " ", (message:gsub("^.*set_target", "set_target"))))";
  const auto lines = logged(script);
  ASSERT_EQ(lines.size(), 10u) << lines[0];
  EXPECT_EQ(lines[0], "0 set_target(target) expected, got 0");
  EXPECT_EQ(lines[1], "0 set_target(target) expected, got 2");
  EXPECT_NE(lines[2].find("number expected, got string"), std::string::npos) << lines[2];
  EXPECT_NE(lines[4].find("number expected, got boolean"), std::string::npos) << lines[4];
  for (int i : {6, 7, 8}) {
    EXPECT_NE(lines[i].find("finite number expected"), std::string::npos) << lines[i];
  }
  EXPECT_NE(lines[9].find("number expected, got nil"), std::string::npos) << lines[9];
  EXPECT_EQ(command().joint_targets_size(), 0);
  EXPECT_EQ(joint(0).target(), 0);
}

TEST_F(Arguments, WrongTypesNameTheLineOfTheScript) {
  const auto failure = start("\n\nrobot.joints.both.set_target('fast')");
  ASSERT_TRUE(failure);
  EXPECT_NE(failure->find("main.lua:3: bad argument #1 to 'set_target' "
                          "(number expected, got string)"),
            std::string::npos)
      << *failure;
}

TEST_F(Arguments, AColonInsteadOfADotIsNamed) {
  const std::string script = R"(
    local _, message = pcall(function() robot.joints.both:set_target(1) end)
    log(message)
    _, message = pcall(function() robot.joints.both:set_target() end)
    log(message)
    _, message = pcall(robot.joints.both.set_target, {set_target = 1}, 2)
    log(message))";
  const auto lines = logged(script);
  ASSERT_EQ(lines.size(), 3u) << lines[0];
  EXPECT_NE(lines[0].find("expected, got 2; write a dot, not a colon"), std::string::npos)
      << lines[0];
  EXPECT_NE(lines[1].find("got table; write a dot, not a colon"), std::string::npos) << lines[1];
  EXPECT_EQ(lines[2].find("colon"), std::string::npos) << lines[2];
}

TEST_F(Arguments, SensorAndActuatorShareATable) {
  EXPECT_EQ(logged("local j = robot.joints "
                   "log(j.both.encoder, type(j.both.set_target)) "
                   "log(j.sensor.encoder, type(j.sensor.set_target)) "
                   "log(j.motor.encoder, type(j.motor.set_target))"),
            (Lines{"0function", "0nil", "nilfunction"}));
}

TEST_F(Arguments, KeptTablesAndFunctionsStayValid) {
  ASSERT_EQ(start("local both, set = robot.joints.both, robot.joints.motor.set_target "
                  "robot.joints = nil robot = nil collectgarbage() "
                  "function step() set(both.encoder * 2) end"),
            std::nullopt);
  for (int tick = 1; tick <= 3; ++tick) {
    sense(0, tick);
    ASSERT_EQ(controller().step(tick), std::nullopt);
    EXPECT_EQ(joint(2).target(), 2 * tick);
  }
}

TEST_F(Arguments, AScriptMayOverwriteItsTables) {
  ASSERT_EQ(start("robot.joints.both.encoder = nil robot.joints.sensor = 5 "
                  "function step() log(robot.joints.both.encoder) end"),
            std::nullopt);
  sense(0, 0.5);
  ASSERT_EQ(controller().step(1), std::nullopt);
  EXPECT_EQ(controller().log().lines.at(0).text, "0.5");
}

TEST_F(Arguments, WritingReadingsAllocatesNothing) {
  ASSERT_EQ(start("function step() end"), std::nullopt);
  ASSERT_EQ(controller().step(1), std::nullopt);
  const auto before = controller().used_memory();
  for (int tick = 2; tick < 1000; ++tick) {
    sense(0, 0.1 * tick);
    ASSERT_EQ(controller().step(tick), std::nullopt);
  }
  EXPECT_EQ(controller().used_memory(), before);
}

TEST_F(Arguments, AStateWithALittleGarbageStaysSmallUnlessItsScriptCollects) {
  const auto most_of = [&](const std::string& first) {
    EXPECT_EQ(start(first + " function step() local t = {1, 2, 3} t.x = t end"), std::nullopt);
    EXPECT_EQ(controller().step(1), std::nullopt);
    const std::size_t before = controller().used_memory();
    std::size_t most = 0;
    for (int tick = 2; tick < 2000; ++tick) {
      EXPECT_EQ(controller().step(tick), std::nullopt);
      most = std::max(most, controller().used_memory());
    }
    return static_cast<double>(most) / static_cast<double>(before);
  };
  EXPECT_LT(most_of(""), 1.4);
  EXPECT_GT(most_of("collectgarbage('stop')"), 3);
}

}  // namespace
}  // namespace ziggurat::lua
