// SPDX-License-Identifier: MIT
#include "run/options/inject_option.h"

#include <gtest/gtest.h>

#include "text/numbers.h"
#include "words_of.h"

namespace ziggurat::run {
namespace {

using namespace std::chrono_literals;
using network::Direction;
using network::Disturbance;
using network::Injection;

TEST(InjectOption, ControllerDirectionAndNumbers) {
  const auto all = to_injection("latency=5ms,jitter=500us,loss=1%");
  EXPECT_EQ(all.controller, "");
  EXPECT_FALSE(all.direction);
  EXPECT_EQ(all.disturbance, (Disturbance{5ms, 500us, 0.01}));
  EXPECT_EQ(to_injection("latency=0.25s").disturbance, (Disturbance{250ms, {}, 0}));
  const auto one = to_injection("drive=commands:loss=100%");
  EXPECT_EQ(one.controller, "drive");
  EXPECT_EQ(one.direction, Direction::commands);
  EXPECT_EQ(one.disturbance, (Disturbance{{}, {}, 1}));
  EXPECT_EQ(to_injection("observations:latency=1ms").direction, Direction::observations);
}

TEST(InjectOption, IdsMayContainAnyCharacter) {
  EXPECT_EQ(to_injection("a=b,c:d=loss=1%,latency=1ms").controller, "a=b,c:d");
  EXPECT_EQ(to_injection("latency=loss=1%").controller, "latency");
}

TEST(InjectOption, WrongTextsAreRefusedWithAnExample) {
  for (const char* text : {"",
                           "5ms",
                           "latency",
                           "latency=",
                           "latency=5",
                           "latency=5 ms",
                           "latency=-5ms",
                           "latency=11s",
                           "latency=nan",
                           "jitter=1ms",
                           "latency=1ms,jitter=2ms",
                           "loss=1",
                           "loss=101%",
                           "loss=-1%",
                           "lag=5ms",
                           "latency=5ms,latency=6ms",
                           "latency=5ms,",
                           ",latency=5ms",
                           "=latency=5ms",
                           "drive:latency=5ms",
                           "drive=command:latency=5ms",
                           "drive=commands:"}) {
    EXPECT_TRUE(fails_with<text::UsageError>("write for example", [&] { to_injection(text); }));
  }
}

scene::Scene scene_of_two() {
  scene::Scene scene;
  scene.controllers.resize(2);
  scene.controllers[0].id = "drive";
  scene.controllers[1].id = "lift";
  return scene;
}

TEST(InjectOption, ThoseThatNameAControllerWin) {
  const std::vector options{to_injection("lift=commands:loss=5%"), to_injection("latency=5ms")};
  const auto injections = injections_of(options, scene_of_two());
  ASSERT_EQ(injections.size(), 2U);
  EXPECT_EQ(injections[0], (Injection{{5ms, {}, 0}, {5ms, {}, 0}}));
  EXPECT_EQ(injections[1], (Injection{{5ms, {}, 0}, {{}, {}, 0.05}}));
  EXPECT_FALSE(injections_of({}, scene_of_two())[0].any());
  EXPECT_THROW(injections_of({to_injection("unknown=loss=1%")}, scene_of_two()), text::UsageError);
}

TEST(InjectOption, MessagesThatTheWorldWaitsForAreNotLost) {
  std::vector<network::Config::Deadline> deadlines(2);
  const auto injections = injections_of({to_injection("lift=loss=1%")}, scene_of_two());
  EXPECT_THROW(check_losses(injections, scene_of_two(), deadlines), text::UsageError);
  deadlines[1].policy = {scene::DeadlineAction::hold, 50, 0};
  EXPECT_NO_THROW(check_losses(injections, scene_of_two(), deadlines));
  const auto delays = injections_of({to_injection("latency=1ms")}, scene_of_two());
  EXPECT_NO_THROW(check_losses(delays, scene_of_two(), {{}, {}}));
}

TEST(InjectOption, DirectorsAreNamedAsControllersAre) {
  scene::Scene scene = scene_of_two();
  scene.directors.emplace_back().id = "judge";
  const auto injections = injections_of({to_injection("judge=latency=5ms,loss=1%")}, scene);
  ASSERT_EQ(injections.size(), 3U);
  EXPECT_FALSE(injections[0].any());
  EXPECT_EQ(injections[2].commands, (Disturbance{5ms, {}, 0.01}));
  EXPECT_TRUE(injections_of({to_injection("latency=5ms")}, scene)[2].any());
  EXPECT_TRUE(fails_with<text::UsageError>("director 'judge'", [&] {
    check_losses(injections, scene, std::vector<network::Config::Deadline>(3));
  }));
}

}  // namespace
}  // namespace ziggurat::run
