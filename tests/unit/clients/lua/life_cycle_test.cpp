// SPDX-License-Identifier: MIT
// Which function of the script runs when.

#include "script_fixture.h"

namespace ziggurat::lua {
namespace {

class LifeCycle : public ScriptTest {
 protected:
  Lines lines() {
    Lines result;
    for (const LogLine& line : controller().log().lines) result.push_back(line.text);
    return result;
  }
};

TEST_F(LifeCycle, RunsInOrder) {
  ASSERT_EQ(start("log('chunk') function init() log('init ', robot.joints.both.encoder) end "
                  "function step() log('step') end function reset() log('reset') end "
                  "function destroy() log('destroy') end"),
            std::nullopt);
  EXPECT_EQ(lines(), (Lines{"chunk", "init 0"}));
  ASSERT_EQ(controller().step(1), std::nullopt);
  ASSERT_EQ(controller().reset(1), std::nullopt);
  ASSERT_EQ(controller().step(1), std::nullopt);
  ASSERT_EQ(controller().destroy(1), std::nullopt);
  EXPECT_EQ(lines(), (Lines{"chunk", "init 0", "step", "reset", "step", "destroy"}));
}

TEST_F(LifeCycle, ResetAndDestroyMayBeMissing) {
  ASSERT_EQ(start("function step() end"), std::nullopt);
  EXPECT_EQ(controller().reset(1), std::nullopt);
  EXPECT_EQ(controller().destroy(1), std::nullopt);
}

TEST_F(LifeCycle, ResetAndDestroyMayBeMissingWhereUndeclaredNamesAreErrors) {
  ASSERT_EQ(start("function step() end "
                  "setmetatable(_G, {__index = function(_, k) error('undeclared ' .. k) end})"),
            std::nullopt);
  EXPECT_EQ(controller().reset(1), std::nullopt);
  EXPECT_EQ(controller().destroy(1), std::nullopt);
  EXPECT_EQ(controller().step(1), std::nullopt);
}

TEST_F(LifeCycle, FunctionsMayBeInherited) {
  ASSERT_EQ(start("setmetatable(_G, {__index = {step = function() log('base') end}})"),
            std::nullopt);
  ASSERT_EQ(controller().step(1), std::nullopt);
  EXPECT_EQ(lines(), (Lines{"base"}));
}

TEST_F(LifeCycle, MissingStepIsAnError) {
  ASSERT_EQ(start("x = 1"), std::nullopt);
  const Failure failure = controller().step(1);
  ASSERT_TRUE(failure);
  EXPECT_NE(failure->find("main.lua: the script has no function step() (in step 1)"),
            std::string::npos)
      << *failure;
}

TEST_F(LifeCycle, MissingInitIsAnError) {
  write("main.lua", "function step() end");
  options_.script = folder() / "main.lua";
  OneRobot another(robot_);
  Controller other(another.robot(), options_);
  const Failure failure = other.start();
  ASSERT_TRUE(failure);
  EXPECT_NE(failure->find("no function init() (in init, tick 0)"), std::string::npos) << *failure;
}

TEST_F(LifeCycle, FunctionsAreLookedUpAtEveryCall) {
  ASSERT_EQ(start("function step() log('first') step = function() log('second') end end"),
            std::nullopt);
  ASSERT_EQ(controller().step(1), std::nullopt);
  ASSERT_EQ(controller().step(2), std::nullopt);
  EXPECT_EQ(lines(), (Lines{"first", "second"}));
}

TEST_F(LifeCycle, ReadingsArriveBeforeEachCall) {
  ASSERT_EQ(start("function step() log(robot.joints.sensor.encoder) end"), std::nullopt);
  sense(1, 0.25);
  ASSERT_EQ(controller().step(1), std::nullopt);
  sense(1, -1);
  ASSERT_EQ(controller().step(2), std::nullopt);
  EXPECT_EQ(lines(), (Lines{"0.25", "-1"}));
}

TEST_F(LifeCycle, GlobalsAreTheRobotsOwn) {
  ASSERT_EQ(start("shared = 1"), std::nullopt);
  write("other.lua", "function init() log(shared) end");
  OneRobot another(robot_);
  options_.script = folder() / "other.lua";
  Controller other(another.robot(), options_);
  ASSERT_EQ(other.start(), std::nullopt);
  EXPECT_EQ(other.log().lines.at(0).text, "nil");
}

}  // namespace
}  // namespace ziggurat::lua
