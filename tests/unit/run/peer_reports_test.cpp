// SPDX-License-Identifier: MIT
#include "run/peer_reports.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/reader.h"

namespace ziggurat::run {
namespace {

constexpr const char* scene_text = R"(<a><framework><experiment ticks_per_second="10"/></framework>
<controllers><external_controller id="c"><actuators/><sensors/></external_controller></controllers>
<media/><physics_engines><dynamics3d id="d"/></physics_engines>
<arena size="9,9,9"/></a>)";
std::string robot_named(const std::string& id) {
  return "<foot-bot id=\"" + id + R"("><body/><controller config="c"/></foot-bot>)";
}

/// A world without robots, and one that is spawned.
struct Spawning : ::testing::Test {
  Spawning() { spawn("late"); }
  void spawn(const std::string& id) {
    const scene::Addition robot = world.additions.read(robot_named(id), world.scene, 10000,
                                                       [](const std::string&) { return false; });
    ASSERT_TRUE(robot.ok());
    world.simulation.spawn(world.scene, robot.entity);
  }
  static supervision::World make() {
    auto read = scene::read_text(scene_text, "a.argos");
    for (const auto& problem : read.problems) ADD_FAILURE() << scene::to_string(problem);
    return {"a.argos", {std::move(read.scene), std::move(read.additions)}, 1};
  }
  supervision::World world = make();
  reports::Console console;
  PeerReports reports{world, console, [](auto...) {}};
};

TEST_F(Spawning, AFailureBeforeAResetIsNotThatOfALaterRobotAtItsPlace) {
  testing::internal::CaptureStderr();
  const std::vector<std::size_t> robots{0};
  EXPECT_FALSE(reports.has_failure(robots));
  network::Report report;
  report.failures.push_back({0, "broken", 7});
  reports.take(std::move(report), 7);
  EXPECT_TRUE(reports.has_failure(robots));
  world.reset(1);
  reports.forget_spawned();
  spawn("late");
  EXPECT_FALSE(reports.has_failure(robots));
  ASSERT_EQ(reports.failures().size(), 1U);
  EXPECT_EQ(reports.failures()[0].robot, "late");
  testing::internal::GetCapturedStderr();
}

TEST_F(Spawning, WhatIsKeptOfThemDoesNotGrowWithResets) {
  testing::internal::CaptureStderr();
  for (int i = 0; i < 3; ++i) {
    network::Report report;
    for (int k = 0; k < 6000; ++k) {
      report.failures.push_back({0, "broken", 7});
      report.departures.push_back({0, 7});
    }
    reports.take(std::move(report), 7);
    world.reset(1);
    reports.forget_spawned();
    spawn("late");
  }
  EXPECT_EQ(reports.failures().size(), 10'000U);
  EXPECT_EQ(reports.departures().size(), 10'000U);
  testing::internal::GetCapturedStderr();
}

TEST_F(Spawning, AFailureIsNotThatOfARobotOfASnapshotAtItsPlace) {
  testing::internal::CaptureStderr();
  const std::vector<std::size_t> robots{0};
  network::Report report;
  report.failures.push_back({0, "broken", 7});
  reports.take(std::move(report), 7);
  world.reset(1);
  spawn("other");  // as a restore does
  reports.forget_spawned();
  EXPECT_FALSE(reports.has_failure(robots));
  EXPECT_EQ(reports.failures().size(), 1U);
  testing::internal::GetCapturedStderr();
}

TEST_F(Spawning, DeparturesAreToldTwentyAtOnceThenOneASecond) {
  std::vector<std::string> told;
  PeerReports telling{world, console,
                      [&](auto, auto, std::string_view text) { told.emplace_back(text); }};
  std::uint64_t tick = 0;
  const auto take = [&](int count, auto now) {
    network::Report report;
    for (int i = 0; i < count; ++i) report.departures.push_back({0, tick++});
    telling.take(std::move(report), 7, now);
  };
  testing::internal::CaptureStderr();
  const auto now = std::chrono::steady_clock::now();
  take(500, now);
  EXPECT_EQ(told.size(), 20U);
  take(0, now + std::chrono::milliseconds{1100});
  testing::internal::GetCapturedStderr();
  ASSERT_EQ(told.size(), 21U);
  EXPECT_TRUE(told.back().ends_with("(479 more before it.)")) << told.back();
}

TEST(PeerReports, LinesOfARobotThatAResetTookAreStillItsOwn) {
  auto read = scene::read_text(scene_text, "a.argos");
  for (const auto& problem : read.problems) ADD_FAILURE() << scene::to_string(problem);
  supervision::World world("a.argos", {std::move(read.scene), std::move(read.additions)}, 1);
  const scene::Addition robot = world.additions.read(robot_named("late"), world.scene, 10000,
                                                     [](const std::string&) { return false; });
  ASSERT_TRUE(robot.ok());
  world.simulation.spawn(world.scene, robot.entity);
  testing::internal::CaptureStdout();
  {
    reports::Console console;
    PeerReports reports(world, console, [](auto...) {});
    network::Report report;
    report.log.push_back({0, false, "hello"});
    reports.take(std::move(report), 7);
    world.reset(1);
    ASSERT_TRUE(world.simulation.layout().robots.empty());
    reports.print_log(7);
  }
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "[7 late] hello\n");
}

}  // namespace
}  // namespace ziggurat::run
