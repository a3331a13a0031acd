// SPDX-License-Identifier: MIT
// log, robot, package.path and what is different in the standard libraries.

#include "script_fixture.h"

namespace ziggurat::lua {
namespace {

class Globals : public ScriptTest {};

TEST_F(Globals, LogPrintsNumbersAsAStreamDoes) {
  EXPECT_EQ(logged("log(1/3) log(1e6, ' ', 123456789.0, ' ', 1e-5, ' ', -0.0, ' ', 2.0) "
                   "log(1/0, ' ', -1/0) log(0.1 + 0.2) log(100000.0)"),
            (Lines{"0.333333", "1e+06 1.23457e+08 1e-05 -0 2", "inf -inf", "0.3", "100000"}));
}

TEST_F(Globals, LogPrintsIntegersWhole) {
  EXPECT_EQ(logged("log(7, ' ', 1000000, ' ', math.mininteger, ' ', 10 // 3)"),
            (Lines{"7 1000000 -9223372036854775808 3"}));
}

TEST_F(Globals, LogConcatenatesWithoutSeparator) {
  EXPECT_EQ(logged("log() log('a', 1, true, false, nil, 'b') log({}, print, '1') log('x\\0y')"),
            (Lines{"", "a110nilb", "{}function1", std::string("x\0y", 3)}));
}

TEST_F(Globals, LogPrintsWhatTablesHold) {
  EXPECT_EQ(logged("log({1, 2.5, 'x'}) log('p = ', {z = 3, x = true, y = {a = {b = {c = 1}}}}) "
                   "log({1, nil, 3, [true] = 2})"),
            (Lines{"{1, 2.5, \"x\"}", "p = {x = 1, y = {a = {b = {…}}}, z = 3}", "{1, …}"}));
  EXPECT_EQ(logged("local t = {} t.t = t log(t)"), (Lines{"{t = {t = {t = {…}}}}"}));
  EXPECT_EQ(logged("local t = {} for i = 1, 200 do t[('k%03d'):format(i)] = i end "
                   "log(t)")[0]
                .substr(0, 22),
            "{k001 = 1, k002 = 2, k");
  EXPECT_TRUE(
      logged("local t = {} for i = 1, 200 do t['k' .. i] = i end log(t)")[0].ends_with(", …}"));
}

TEST_F(Globals, LogOfHugeTablesIsBounded) {
  const auto lines = logged(
      "local s = ('x'):rep(1e6) local t = {} for i = 1, 1e5 do t[i] = {s, s, a = {b = s}} end "
      "log(t)");
  ASSERT_FALSE(lines.empty());
  EXPECT_LE(lines[0].size(), LogLines::max_bytes + 100);
}

TEST_F(Globals, LogAndLogerrDiffer) {
  ASSERT_EQ(start("log('out') logerr('err ', 1.5)"), std::nullopt);
  const auto& lines = controller().log().lines;
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_FALSE(lines[0].is_error);
  EXPECT_TRUE(lines[1].is_error);
  EXPECT_EQ(lines[1].text, "err 1.5");
}

TEST_F(Globals, LogIsBounded) {
  ASSERT_EQ(start("local line = ('x'):rep(1000) for i = 1, 100000 do log(line) end "
                  "function step() log('again') end"),
            std::nullopt);
  auto& log = controller().log();
  EXPECT_LE(log.lines.size(), LogLines::max_bytes / 1000 + 1);
  EXPECT_TRUE(log.lines.back().is_error);
  log.clear();
  ASSERT_EQ(controller().step(1), std::nullopt);
  EXPECT_EQ(log.lines.at(0).text, "again");
}

TEST_F(Globals, RobotExistsBeforeTheChunkRuns) {
  EXPECT_EQ(logged("log(robot.id, ' ', robot.params.speed, ' ', type(robot.params.speed), ' ', "
                   "robot.params.script, ' ', robot.params.none, ' ', type(robot.random.uniform))"),
            (Lines{"r0 2 string main.lua nil function"}));
}

TEST_F(Globals, RobotHasOnlyTheControllersDevices) {
  robot_.clear_joint_sensors();
  robot_.clear_joint_actuators();
  EXPECT_EQ(logged("log(robot.joints)"), (Lines{"nil"}));
}

TEST_F(Globals, ModulesAreFoundInTheScriptsFolder) {
  write("gait.lua", "return {period = 4}");
  std::filesystem::create_directory(folder() / "sub");
  write("sub/init.lua", "return 'package'");
  EXPECT_EQ(logged("log(require('gait').period, require('sub'))"), (Lines{"4package"}));
}

TEST_F(Globals, StandardLibrariesAreOpen) {
  EXPECT_EQ(logged("log(type(io.open), type(os.time), type(string.format), type(utf8.char), "
                   "type(coroutine.wrap), type(debug.traceback), type(table.sort), _VERSION)"),
            (Lines{"functionfunctionfunctionfunctionfunctionfunctionfunctionLua 5.3"}));
}

TEST_F(Globals, ExitIsRefused) {
  const auto failure = start("os.exit(0)");
  ASSERT_TRUE(failure);
  EXPECT_NE(failure->find("os.exit is not allowed"), std::string::npos);
}

TEST_F(Globals, TheLocaleCannotBeChanged) {
  EXPECT_EQ(logged("log(os.setlocale('de_DE.UTF-8'), os.setlocale(), os.setlocale('C'))"),
            (Lines{"nilCC"}));
}

TEST_F(Globals, PairsFollowsTheKeys) {
  EXPECT_EQ(logged(R"(
    local t = {d = 1, b = 2, [3.5] = 3, [-1] = 4, 'one', 'two', a10 = 5, a9 = 6, [true] = 7}
    local keys = {}
    for key in pairs(t) do keys[#keys + 1] = tostring(key) end
    log(table.concat(keys, ' ')))"),
            (Lines{"-1 1 2 3.5 a10 a9 b d true"}));
}

TEST_F(Globals, PairsOfManyNamesIsTheSameInEveryState) {
  const std::string script =
      "local t = {} for i = 1, 100 do t['name' .. i * 7919 % 101] = i end "
      "local s = '' for k, v in pairs(t) do s = s .. k .. '=' .. v .. ' ' end log(s)";
  const auto first = logged(script);
  ASSERT_GT(first.at(0).size(), 900u);
  EXPECT_EQ(first, logged(script));
  EXPECT_EQ(first.at(0).substr(0, 6), "name1=");
}

TEST_F(Globals, PairsAllowsFieldsToBeClearedAndHonoursItsMetamethod) {
  EXPECT_EQ(logged(R"(
    local t, seen = {a = 1, b = 2, c = 3}, ''
    for k in pairs(t) do seen = seen .. k; t[k] = nil; t.b = nil end
    log(seen, next(t))
    local custom = setmetatable({}, {__pairs = function() return function(_, k) if not k then return 'x', 9 end end end})
    for k, v in pairs(custom) do log(k, v) end
    for k in pairs({}) do log('never') end
    log(pcall(pairs)) log(pcall(pairs, nil)))"),
            (Lines{"acnil", "x9", "0bad argument #1 to 'pairs' (table expected, got no value)",
                   "0bad argument #1 to 'pairs' (table expected, got nil)"}));
}

}  // namespace
}  // namespace ziggurat::lua
