// SPDX-License-Identifier: MIT
// robot.random and math.random: ranges, moments, streams.

#include "script_fixture.h"

namespace ziggurat::lua {
namespace {

const std::string draw_ten = R"(
  local r, s = robot.random, ''
  for i = 1, 10 do s = s .. r.uniform_int(1000000) .. ' ' end
  log(s))";

class Random : public ScriptTest {
 protected:
  Lines drawn(std::uint64_t seed, const std::string& id, const std::string& script = draw_ten) {
    options_.seed = seed;
    robot_.set_id(id);
    return logged(script);
  }
};

TEST_F(Random, DependsOnlyOnSeedAndRobot) {
  EXPECT_EQ(drawn(1, "r0"), drawn(1, "r0"));
  EXPECT_NE(drawn(1, "r0"), drawn(2, "r0"));
  EXPECT_NE(drawn(1, "r0"), drawn(1, "r1"));
}

TEST_F(Random, TheFirstNumbersAreTheSameOnEveryMachine) {
  EXPECT_EQ(drawn(7, "r0", "log(robot.random.uniform_int(1000000), ' ', math.random(1000000))"),
            (Lines{"129580 340050"}));
}

TEST_F(Random, RestartsAtReset) {
  ASSERT_EQ(start("function reset() log(robot.random.uniform(), ' ', math.random()) end reset()"),
            std::nullopt);
  auto& log = controller().log();
  ASSERT_EQ(controller().reset(1), std::nullopt);
  ASSERT_EQ(log.lines.size(), 2u);
  EXPECT_EQ(log.lines[0].text, log.lines[1].text);
  ASSERT_EQ(controller().reset(2), std::nullopt);
  EXPECT_NE(log.lines[0].text, log.lines[2].text);
}

TEST_F(Random, MathRandomDoesNotDisturbRobotRandom) {
  EXPECT_EQ(drawn(1, "r0"), drawn(1, "r0", "math.randomseed(5) math.random() " + draw_ten));
}

TEST_F(Random, StaysInItsRanges) {
  EXPECT_EQ(logged(R"(
    local r = robot.random
    for i = 1, 10000 do
      local u = r.uniform() assert(0 <= u and u <= 1)
      u = r.uniform(5) assert(0 <= u and u <= 5)
      u = r.uniform(-3, -2.5) assert(-3 <= u and u <= -2.5)
      u = r.uniform_int(5) assert(0 <= u and u < 5 and math.type(u) == 'integer')
      u = r.uniform_int(-3, 3) assert(-3 <= u and u < 3)
      u = r.uniform_int(math.mininteger, math.maxinteger) assert(u < math.maxinteger)
      u = r.bernoulli() assert(u == 0 or u == 1)
      assert(r.exponential(2) >= 0)
      u = r.poisson(3) assert(u >= 0 and math.type(u) == 'integer')
      u = math.random() assert(0 <= u and u < 1)
      u = math.random(6) assert(1 <= u and u <= 6 and math.type(u) == 'integer')
      u = math.random(-2, 2) assert(-2 <= u and u <= 2)
    end
    assert(r.uniform(0.1, 0.1) == 0.1 and r.uniform_int(4, 4) == 4 and r.poisson(0) == 0)
    assert(r.bernoulli(0) == 0 and r.bernoulli(1) == 1)
    assert(r.uniform_int(2.9, 3.9) == 2 and r.uniform_int(-0.5, 0) == -1)
    log('good'))"),
            (Lines{"good"}));
}

TEST_F(Random, ReachesEveryInteger) {
  EXPECT_EQ(logged(R"(
    local seen = {}
    for i = 1, 2000 do
      local n = robot.random.uniform_int(-2, 3)
      seen[n] = (seen[n] or 0) + 1
    end
    for n = -2, 2 do assert(seen[n] > 300 and seen[n] < 500, n .. ' ' .. tostring(seen[n])) end
    local dice = {}
    for i = 1, 1200 do local n = math.random(2, 4) dice[n] = (dice[n] or 0) + 1 end
    for n = 2, 4 do assert(dice[n] > 300) end
    log('good'))"),
            (Lines{"good"}));
}

TEST_F(Random, HasTheRightMoments) {
  EXPECT_EQ(logged(R"(
    local function check(name, mean, variance, draw)
      local n, sum, squares = 20000, 0, 0
      for i = 1, n do local x = draw() sum = sum + x squares = squares + x * x end
      local m = sum / n
      local v = squares / n - m * m
      assert(math.abs(m - mean) < 5 * math.sqrt(variance / n), name .. ' mean ' .. m)
      assert(math.abs(v - variance) < 0.1 * variance, name .. ' variance ' .. v)
    end
    local r = robot.random
    check('bernoulli', 0.3, 0.21, function() return r.bernoulli(0.3) end)
    check('fair', 0.5, 0.25, r.bernoulli)
    check('uniform', 1, 4 / 3, function() return r.uniform(-1, 3) end)
    check('exponential', 2, 4, function() return r.exponential(2) end)
    check('gaussian', 5, 9, function() return r.gaussian(3, 5) end)
    check('standard', 0, 0.25, function() return r.gaussian(0.5) end)
    check('poisson', 2.5, 2.5, function() return r.poisson(2.5) end)
    check('many', 1000, 1000, function() return r.poisson(1000) end)
    log('good'))"),
            (Lines{"good"}));
}

TEST_F(Random, RefusesInvalidArguments) {
  EXPECT_EQ(logged(R"(
    local r = robot.random
    local function refused(f, ...) assert(not pcall(f, ...)) end
    refused(r.bernoulli, 0.5, 1) refused(r.bernoulli, '0.5') refused(r.bernoulli, 0/0)
    refused(r.uniform, 1, 2, 3) refused(r.uniform, 2, 1) refused(r.uniform, -1) refused(r.uniform, nil)
    refused(r.uniform_int) refused(r.uniform_int, 3, 2) refused(r.uniform_int, -1)
    refused(r.uniform_int, 1e300) refused(r.uniform_int, {})
    refused(r.exponential) refused(r.exponential, 1, 2)
    refused(r.gaussian) refused(r.gaussian, 1, 2, 3) refused(r.gaussian, 1/0)
    refused(r.poisson) refused(r.poisson, -1) refused(r.poisson, 1e300)
    refused(math.random, 0) refused(math.random, 3, 2) refused(math.random, 0.5)
    log('good'))"),
            (Lines{"good"}));
}

}  // namespace
}  // namespace ziggurat::lua
