// SPDX-License-Identifier: MIT
// An endless loop ends with file and line, wherever it runs; other scripts are not affected.

#include <ctime>

#include "script/interrupt.h"
#include "script_fixture.h"

// Functions of the leak sanitizer; null without it.
extern "C" void __lsan_disable() __attribute__((weak));
extern "C" void __lsan_enable() __attribute__((weak));

namespace ziggurat::lua {
namespace {

/// Memory that is allocated meanwhile is no leak: the state of a call that is left is never freed.
struct LeavesState {
  LeavesState() {
    if (__lsan_disable) __lsan_disable();
  }
  ~LeavesState() {
    if (__lsan_enable) __lsan_enable();
  }
  LeavesState(const LeavesState&) = delete;
  LeavesState& operator=(const LeavesState&) = delete;
};

class Limits : public ScriptTest {
 protected:
  Limits() {
    watch_scripts();
    folders_.emplace(std::vector<std::filesystem::path>{folder()});
    options_.folders = &*folders_;
    options_.max_instructions = 20'000'000;
  }

  void expect_ended(const std::string& script, const std::string& line) {
    const Failure failure = start(script);
    ASSERT_TRUE(failure) << script;
    EXPECT_NE(
        failure->find("main.lua:" + line + ": runs more than 20 million instructions in one call"),
        std::string::npos)
        << *failure;
  }

  std::optional<Folders> folders_;
};

TEST_F(Limits, EndALoopWithItsLine) { expect_ended("\n\nwhile true do\nend", "3"); }

TEST_F(Limits, NameThePlaceOnce) {
  const Failure failure = start(
      "local function loop()\nwhile true do end end\nlocal function outer() loop() end\nouter()");
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->find("main.lua"), failure->find("main.lua:2: runs more than")) << *failure;
}

TEST_F(Limits, EndALoopThatCatchesErrors) {
  const Failure failure = start("while true do pcall(function() while true do end end) end");
  ASSERT_TRUE(failure);
  EXPECT_NE(failure->find("20 million instructions"), std::string::npos) << *failure;
}

TEST_F(Limits, EndALoopInACoroutine) {
  expect_ended("\nlocal f = coroutine.wrap(function()\nwhile true do end end)\nf()", "3");
}

TEST_F(Limits, EndLoopsOverCoroutines) {
  for (const char* script :
       {"while true do coroutine.wrap(function() for i = 1, 1e5 do end end)() end",
        "local c = coroutine.wrap(function() while true do coroutine.yield() end end) "
        "while true do c() end",
        "while true do coroutine.resume(coroutine.create(function() while true do end end)) end",
        "local function deep() coroutine.wrap(deep)() end while true do pcall(deep) end",
        "while true do xpcall(error, function() while true do end end) end",
        "local t = setmetatable({}, {__index = function(t, k) return t[k + 1] end}) "
        "while true do pcall(function() return t[1] end) end",
        "table.sort({1, 2, 3}, function() while true do end end)",
        "string.gsub('x', 'x', function() while true do end end)",
        "load(function() while true do end end)"}) {
    const Failure failure = start(script);
    ASSERT_TRUE(failure) << script;
    EXPECT_NE(failure->find("20 million instructions"), std::string::npos) << script << "\n"
                                                                           << *failure;
  }
}

TEST_F(Limits, HoldForEachCall) {
  ASSERT_EQ(start("function step() for i = 1, 4e6 do end end"), std::nullopt);
  for (std::uint64_t tick = 1; tick <= 20; ++tick) {
    ASSERT_EQ(controller().step(tick), std::nullopt) << tick;
  }
}

TEST_F(Limits, OfOneRobotDoNotAffectAnother) {
  ASSERT_EQ(start("function step() log('here') end"), std::nullopt);
  write("loop.lua", "function init() end function step() while true do end end");
  OneRobot another(robot_);
  ScriptOptions options = options_;
  options.script = folder() / "loop.lua";
  Controller loop(another.robot(), options);
  ASSERT_EQ(loop.start(), std::nullopt);
  EXPECT_TRUE(loop.step(1));
  ASSERT_EQ(controller().step(1), std::nullopt);
  EXPECT_EQ(controller().log().lines.at(0).text, "here");
}

// Each call of the library is short, and little Lua runs between them.
TEST_F(Limits, EndCallsThatComputeForLongInTheLibrary) {
  options_.max_computing = 1;
  const std::string slow_find =
      "local s, p = ('a'):rep(15), ('a?'):rep(15) .. ('a'):rep(15) .. 'b' ";
  for (const char* loop :
       {"while true do s:find(p) end", "while true do pcall(string.find, s, p) end",
        "coroutine.wrap(function() while true do pcall(s.find, s, p) end end)()",
        "while true do coroutine.wrap(function() s:find(p) end)() end",
        "while true do pcall(function() while true do s:find(p) end end) end",
        "local t = {} for i = 1, 3e5 do t[i] = 'twenty bytes of text' end while true do "
        "table.concat(t) end",
        "while true do io.open('main.lua') end"}) {
    const Failure failure = start("\n" + slow_find + "\n" + loop);
    ASSERT_TRUE(failure) << loop;
    EXPECT_NE(failure->find("main.lua:3: computes for more than 1 s in one call"),
              std::string::npos)
        << loop << "\n"
        << *failure;
    EXPECT_EQ(failure->find("main.lua"), failure->find("main.lua:3: computes"))
        << *failure;  // the place stands once
  }
}

// Each allocation costs a full collection of garbage.
TEST_F(Limits, EndAScriptThatStaysAtTheLimitOfItsMemory) {
  options_.max_computing = 1;
  options_.max_memory = std::size_t{128} << 20;
  const std::clock_t begin = std::clock();
  const Failure failure = start(
      "local keep = {}\n"
      "local function fill() while true do keep[#keep + 1] = {} end end\n"
      "local function deep(n) while true do pcall(n < 50 and deep or fill, n + 1) end end\n"
      "deep(1)");
  ASSERT_TRUE(failure);
  EXPECT_NE(failure->find(": computes for more than 1 s in one call"), std::string::npos)
      << *failure;
  EXPECT_LT(std::clock() - begin, 15 * CLOCKS_PER_SEC);  // of processor time
}

TEST_F(Limits, OfTimeHoldForEachCall) {
  options_.max_computing = 1;
  ASSERT_EQ(
      start("local s, p = ('a'):rep(15), ('a?'):rep(15) .. ('a'):rep(15) .. 'b' "
            "function step() local t = os.clock() while os.clock() - t < 0.6 do s:find(p) end end"),
      std::nullopt);
  for (std::uint64_t tick = 1; tick <= 4; ++tick)
    ASSERT_EQ(controller().step(tick), std::nullopt) << tick;
}

TEST_F(Limits, CoroutinesWorkAsInLua) {
  EXPECT_EQ(
      logged("local c = coroutine.create(function(a, b) local x = coroutine.yield(a + b) "
             "error('no' .. x, 0) end) "
             "log(coroutine.resume(c, 1, 2)) log(coroutine.resume(c, 'p')) "
             "log(coroutine.resume(c)) log(coroutine.status(c)) "
             "local g = coroutine.wrap(function() for i = 1, 2 do coroutine.yield(i) end end) "
             "log(g(), g(), select('#', g())) log(pcall(g)) log(pcall(coroutine.resume, 1)) "
             "log(coroutine.wrap(function() return coroutine.isyieldable() end)())"),
      (Lines{"13", "0nop", "0cannot resume dead coroutine", "dead", "120",
             "0cannot resume dead coroutine",
             "0bad argument #1 to 'coroutine.resume' (coroutine expected)", "1"}));
}

// A function that can't be left: hooks do not run in a finalizer.
TEST_F(Limits, WhatCannotBeLeftEndsTheProcessAndNamesTheRobotAndItsLine) {
  options_.folders = nullptr;  // trusted: others have no finalizers
  EXPECT_EXIT(
      {
        options_.max_in_library = 1;
        watch_scripts();  // a child process has no timer yet
        start("setmetatable({}, {__gc = function()\nwhile true do end end})\ncollectgarbage()");
      },
      testing::ExitedWithCode(3), "'r0': .*main.lua:2: calls a library function");
}

// Also while Lua allocates memory, in coroutines, in metamethods and between calls of functions of
// C.
TEST_F(Limits, ALibraryFunctionThatDoesNotEndIsLeft) {
  const LeavesState in_this_test;
  options_.max_in_library = 1;
  const std::string pattern = "local s, p = ('x'):rep(40), ('x*'):rep(20) .. 'y' ";
  for (const auto& [script, function] : std::vector<std::pair<std::string, std::string>>{
           {"pcall(s.match, s, p)", "string.match"},
           {"for word in s:gmatch(p) do end", "string.gmatch"},
           {"coroutine.wrap(function() s:gsub(p, '') end)()", "string.gsub"},
           {"table.move({}, 1, math.maxinteger - 9, 2, {})", "table.move"}}) {
    const Failure failure = start(pattern + "\n" + script);
    ASSERT_TRUE(failure) << script;
    EXPECT_NE(failure->find("main.lua:2: " + function +
                            " computes for more than 1 s in one call (in its chunk, tick 0)"),
              std::string::npos)
        << script << "\n"
        << *failure;
  }
}

TEST_F(Limits, ALibraryFunctionThatIsACoroutineIsLeftWithoutLine) {
  const LeavesState in_this_test;
  options_.max_in_library = 1;
  const Failure failure = start("coroutine.wrap(table.move)({}, 1, math.maxinteger - 9, 2, {})");
  ASSERT_TRUE(failure);
  EXPECT_NE(failure->find("main.lua: table.move computes for more than 1 s in one call"),
            std::string::npos)
      << *failure;
}

TEST_F(Limits, ALibraryFunctionThatAllocatesIsLeftAndOtherScriptsGoOn) {
  const LeavesState in_this_test;
  ASSERT_EQ(start("function step() local t = {} for i = 1, 1e4 do t[i] = {i} end log(#t) end"),
            std::nullopt);
  options_.max_in_library = 1;
  write("stuck.lua",
        "function init() end\n"
        "function step() table.move({}, 1, 1 << 60, 2, setmetatable({}, {__newindex = "
        "table.pack})) end");
  OneRobot another(robot_);
  ScriptOptions options = options_;
  options.script = folder() / "stuck.lua";
  Controller stuck(another.robot(), options);
  ASSERT_EQ(stuck.start(), std::nullopt);
  const Failure failure = stuck.step(1);
  ASSERT_TRUE(failure);
  EXPECT_NE(failure->find("computes for more than 1 s in one call (in step 1)"), std::string::npos)
      << *failure;
  for (std::uint64_t tick = 1; tick <= 100; ++tick)
    ASSERT_EQ(controller().step(tick), std::nullopt) << tick;
  EXPECT_EQ(controller().log().lines.at(99).text, "10000");
  const Failure again = start("while true do end");  // the signal still arrives
  ASSERT_TRUE(again);
  EXPECT_NE(again->find("20 million instructions"), std::string::npos) << *again;
}

TEST_F(Limits, ALibraryFunctionComputesForFiveSeconds) {
  const LeavesState in_this_test;
  const std::clock_t begin = std::clock();
  const Failure failure = start("('x'):rep(40):find(('x*'):rep(20) .. 'y')");
  ASSERT_TRUE(failure);
  EXPECT_LT(std::clock() - begin, 6 * CLOCKS_PER_SEC);  // of processor time
  EXPECT_GT(std::clock() - begin, 4 * CLOCKS_PER_SEC);
}

}  // namespace
}  // namespace ziggurat::lua
