// SPDX-License-Identifier: MIT
// The message of a failed script names robot, line and tick; other scripts are not affected.

#include <csignal>
#include <thread>

#include "script/interrupt.h"
#include "script_fixture.h"

namespace ziggurat::lua {
namespace {

class Errors : public ScriptTest {
 protected:
  static void expect_contains(const Failure& failure, const std::string& part) {
    ASSERT_TRUE(failure);
    EXPECT_NE(failure->find(part), std::string::npos) << *failure;
  }
};

TEST_F(Errors, NameScriptLineAndTickWithATraceback) {
  ASSERT_EQ(start("\nlocal function inner() local x = nil; return x.y end\n"
                  "function step() inner() end"),
            std::nullopt);
  const Failure failure = controller().step(37);
  ASSERT_TRUE(failure);
  expect_contains(failure, "main.lua:2: attempt to index a nil value (local 'x') (in step 37)\n");
  expect_contains(failure, "stack traceback:\n");
  expect_contains(failure, "main.lua:2: in upvalue 'inner'");
  expect_contains(failure, "main.lua:3: in function 'step'");
}

TEST_F(Errors, InTheChunk) {
  expect_contains(start("\nerror('no')"), "main.lua:2: no (in its chunk, tick 0)\n");
}

TEST_F(Errors, InInit) {
  expect_contains(start("function init() error('no') end"), "main.lua:1: no (in init, tick 0)\n");
}

TEST_F(Errors, InReset) {
  ASSERT_EQ(start("function reset() error('no') end"), std::nullopt);
  expect_contains(controller().reset(1), "(in reset, tick 0)");
}

TEST_F(Errors, InDestroy) {
  ASSERT_EQ(start("function destroy() error('no') end"), std::nullopt);
  expect_contains(controller().destroy(9), "(in destroy, after tick 9)");
}

TEST_F(Errors, InSyntax) { expect_contains(start("\n\nfunction ("), "main.lua:3: "); }

TEST_F(Errors, NoSuchScript) {
  options_.script = folder() / "missing.lua";
  OneRobot another(robot_);
  Controller other(another.robot(), options_);
  expect_contains(other.start(), "missing.lua");
}

TEST_F(Errors, PrecompiledChunksAreRefused) {
  write("main.lua", std::string("\x1bLua") + "garbage");
  options_.script = folder() / "main.lua";
  OneRobot another(robot_);
  Controller other(another.robot(), options_);
  expect_contains(other.start(), "attempt to load a binary chunk");
}

TEST_F(Errors, OtherThanStringsNameTheScriptToo) {
  expect_contains(start("error({})"), "main.lua: (the error is a table value) (in its chunk");
  expect_contains(start("error()"), "main.lua: (the error is a nil value)");
  expect_contains(start("error(setmetatable({}, {__tostring = function() return 'mine' end}))"),
                  "main.lua: mine");
  expect_contains(start("error('bare', 0)"), "main.lua: bare");
  expect_contains(start("error(42)"), "42 (in its chunk");
}

TEST_F(Errors, OfWhatTheRobotLacksNameItAndWhatItHas) {
  ASSERT_EQ(
      start("local absent = robot.radios == nil and not robot.joints.nothing\n"
            "function step() if not robot.radios and absent then robot.radios.r.send({}) end end"),
      std::nullopt);
  const Failure failure = controller().step(1);
  expect_contains(failure, "main.lua:2: attempt to index a nil value (field 'radios'): robot '");
  expect_contains(failure, " has no robot.radios; robot has: ");
  expect_contains(start("local x = {}; local y = robot.nothing; x.other.z = 1"),
                  "(field 'other') (in its chunk");
  expect_contains(start("robot.params.gain.x = 1"),
                  " has no robot.params.gain; robot.params has: script, speed (in its chunk");
}

TEST_F(Errors, OfAComparisonNameTheGlobalThatIsNil) {
  expect_contains(start("if count > 3 then log('many') end"),
                  "attempt to compare number with nil: the last global that was read, 'count', is "
                  "nil (in its chunk");
  expect_contains(start("for i = 1, most do end"), "the last global that was read, 'most', is nil");
  expect_contains(start("robot.joints.both.set_target(speed)"),
                  "the last global that was read, 'speed', is nil");
  const Failure named = start("local x = absent; missing()");
  expect_contains(named, "attempt to call a nil value (global 'missing') (in its chunk");
  ASSERT_EQ(start("local absent = earlier function step() local a, b = nil, 1 return a < b end"),
            std::nullopt);
  const Failure other = controller().step(1);
  EXPECT_EQ(other->find("earlier"), std::string::npos)
      << *other << ": that was read by another call";
}

// It ended the process, and with it the scripts of all its robots, as a library function that does
// not end.
TEST_F(Errors, OfAScriptWithHugeTablesComeAtOnce) {
  const std::string huge =
      "local rows = {} for i = 1, 30000 do rows['row' .. i] = {} end "
      "for i = 1, 30000 do robot['copy' .. i] = rows end ";
  expect_contains(start(huge + "robot.params.gain.x = 1"), "nil value (field 'gain')");
}

TEST_F(Errors, OfWhatIsNoFunctionSayIt) {
  ASSERT_EQ(start("function init() end step = 5"), std::nullopt);
  expect_contains(controller().step(1),
                  "main.lua: step is a number, not a function; write: function step()");
}

TEST_F(Errors, InTheErrorItself) {
  EXPECT_TRUE(start("error(setmetatable({}, {__tostring = function() error('again') end}))"));
}

TEST_F(Errors, LongOnesAreShortened) {
  const Failure failure = start("error(('x'):rep(1000000))");
  ASSERT_TRUE(failure);
  EXPECT_LT(failure->size(), 40000u);
}

TEST_F(Errors, CaughtByTheScriptDoNotFail) {
  EXPECT_EQ(logged("log(pcall(error, 'mine', 0)) log((select(2, xpcall(function() error('x') end, "
                   "function(m) return 'handled' end))))"),
            (Lines{"0mine", "handled"}));
}

TEST_F(Errors, RecursionWithoutBound) {
  expect_contains(start("local function f() return 1 + f() end f()"), "stack overflow");
  expect_contains(start("local s = ('('):rep(1000) .. (')'):rep(1000) string.find('', s)"),
                  "too many captures");
}

TEST_F(Errors, MemoryWithoutBound) {
  options_.max_memory = 8 << 20;
  const Failure failure = start("local t = {} while true do t[#t + 1] = ('x'):rep(1000) .. #t end");
  expect_contains(failure,
                  "main.lua:1: not enough memory (it may have 8 MiB) (in its chunk, tick 0)");
  EXPECT_LE(controller().used_memory(), std::size_t{8} << 20);
}

TEST_F(Errors, ABufferWithoutMemory) {
  options_.max_memory = 8 << 20;
  expect_contains(start("local s = ('x'):rep(9 << 20)"), "(it may have 8 MiB)");
}

TEST_F(Errors, OneStringTooLong) {
  options_.max_memory = 8 << 20;
  expect_contains(start("local s = ('x'):rep(1 << 40)"), "main.lua");
}

TEST_F(Errors, TooLittleMemoryForTheLibraries) {
  options_.max_memory = 16 << 10;
  expect_contains(start("log(1)"), "not enough memory");
}

TEST_F(Errors, InACoroutineNameItsLine) {
  expect_contains(start("\nlocal f = coroutine.wrap(function() error('deep') end) f()"),
                  "main.lua:2: deep");
}

TEST_F(Errors, WhatWasLoggedAndSetBeforeIsKept) {
  ASSERT_EQ(start("function step() log('before') robot.joints.both.set_target(3) error('no') end"),
            std::nullopt);
  EXPECT_TRUE(controller().step(1));
  EXPECT_EQ(controller().log().lines.at(0).text, "before");
  EXPECT_EQ(joint(0).target(), 3);
}

TEST_F(Errors, OfOneRobotDoNotAffectAnother) {
  ASSERT_EQ(start("n = 0 function step() n = n + 1 log(n) end"), std::nullopt);
  write("other.lua", "function init() end n = 100 function step() n = nil + 1 end");
  OneRobot another(robot_);
  options_.script = folder() / "other.lua";
  Controller other(another.robot(), options_);
  ASSERT_EQ(other.start(), std::nullopt);
  EXPECT_TRUE(other.step(1));
  ASSERT_EQ(controller().step(1), std::nullopt);
  EXPECT_EQ(controller().log().lines.at(0).text, "1");
}

/// Interrupts scripts from a signal handler.
class Interrupts : public Errors {
 protected:
  Interrupts() {
    std::signal(SIGUSR1, [](int) { interrupt_scripts(); });
  }
  /// In 20 ms, while a script runs or before: either way it ends.
  void interrupt_soon() {
    const auto script = ::pthread_self();
    signaller_ = std::thread([script] {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      ::pthread_kill(script, SIGUSR1);
    });
  }
  ~Interrupts() override {
    if (signaller_.joinable()) signaller_.join();
    allow_scripts();
    std::signal(SIGUSR1, SIG_DFL);
  }
  std::thread signaller_;
};

TEST_F(Interrupts, EndALoop) {
  interrupt_soon();
  expect_contains(start("while true do end"), "interrupted");
}

TEST_F(Interrupts, EndALoopThatCatchesErrors) {
  interrupt_soon();
  expect_contains(start("while true do pcall(function() while true do end end) end"),
                  "interrupted");
}

TEST_F(Interrupts, EndLaterCalls) {
  ASSERT_EQ(start("function step() end"), std::nullopt);
  interrupt_soon();
  signaller_.join();
  ASSERT_TRUE(are_scripts_interrupted());
  expect_contains(controller().step(1), "interrupted");
}

}  // namespace
}  // namespace ziggurat::lua
