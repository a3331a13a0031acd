// SPDX-License-Identifier: MIT
// Cameras in a scene whose bodies hide devices.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>

#include "../long_runs.h"
#include "../simulation/small_scene.h"
#include "devices/camera.h"
#include "devices/tick.h"

namespace ziggurat::camera {
namespace {

using simulation::Simulation;
using simulation::testing::robot;
using simulation::testing::SmallScene;

constexpr const char* all_detectors =
    R"(<led_detector medium="leds"/><directional_led_detector medium="beams"/>)"
    R"(<tag_detector medium="tags"/>)";

/// A camera 1 cm in front of the robot's base, 5 cm up, that looks along +x.
std::string camera(const std::string& more = "", const std::string& detectors = all_detectors,
                   const std::string& id = "front", const std::string& position = "0.06,0,0.05") {
  return "<camera id=\"" + id + R"(" anchor="base" position=")" + position +
         R"(" orientation="-90,90,0" range="0.02:2" focal_length="800,800" )" +
         R"(principal_point="320,240" resolution="640,480" )" + more + ">" + detectors +
         "</camera>";
}

std::string cameras(const std::string& list, const std::string& more = "") {
  return R"(<cameras implementation="default" )" + more + ">" + list + "</cameras>";
}

std::string box(const std::string& position, const std::string& size) {
  return R"(<box id="box at )" + position + "\" size=\"" + size +
         R"(" movable="false"><body position=")" + position + R"("/></box>)";
}

/// Devices without a controller on a box of 4 cm; its near face is at x = 0.48 m, its bottom at z =
/// 0.03 m.
std::string carrier(const std::string& devices, const std::string& position = "0.5,0,0.03") {
  return R"(<prototype id="carrier" movable="false"><body position=")" + position +
         R"("/><links ref="b"><link id="b" geometry="box" size=".04,.04,.04" mass="1"/></links>)" +
         "<devices>" + devices + "</devices></prototype>";
}

std::string tag(double x, const std::string& orientation = "0,-90,0") {
  std::ostringstream text;
  text << R"(<tags medium="tags"><tag anchor="b" payload="7" side_length="0.02" )"
       << R"(observable_angle="80" position=")" << x << R"(,0,0.02" orientation=")" << orientation
       << R"("/></tags>)";
  return text.str();
}

std::string led(double x) {
  std::ostringstream text;
  text << R"(<leds medium="leds"><led anchor="b" color="red" offset=")" << x
       << R"(,0,0.02"/></leds>)";
  return text.str();
}

std::unique_ptr<Simulation> after_one_tick(const std::string& arena,
                                           const std::string& sensors = cameras(camera())) {
  const SmallScene scene{"", sensors, robot("r", "0,0,0", "") + arena, ""};
  auto simulation = std::make_unique<Simulation>(scene.read(), simulation::Options{});
  EXPECT_TRUE(simulation->observations().tags.empty());
  simulation->step();
  return simulation;
}

std::size_t tags_seen(const std::string& arena) {
  return after_one_tick(arena)->observations().tags.size();
}
std::size_t leds_seen(const std::string& arena) {
  return after_one_tick(arena)->observations().leds.size();
}

TEST(Cameras, SeeTheReferencesTagAtTheReferencesPixels) {
  // Values of beta50: a tag of 2 cm at x = 0.4495 m, seen from x = 0.06 m.
  const auto simulation = after_one_tick(carrier(tag(-0.0205), "0.47,0,0.03"));
  ASSERT_EQ(simulation->observations().tags.size(), 1u);
  const world::TagReading& reading = simulation->observations().tags[0];
  EXPECT_EQ(simulation->state().tag_payloads[reading.tag], "7");
  const math::Vector2 corners[4] = {
      {340.539, 260.539}, {299.461, 260.539}, {299.461, 219.461}, {340.539, 219.461}};
  for (int i = 0; i < 4; ++i) EXPECT_LT((reading.corners[i] - corners[i]).norm(), 1e-3) << i;
  EXPECT_LT((reading.center - math::Vector2(320, 240)).norm(), 1e-9);
}

TEST(Cameras, SeeDevicesThatAreMountedFlush) {
  EXPECT_EQ(tags_seen(carrier(tag(-0.02))), 1u);
  EXPECT_EQ(leds_seen(carrier(led(-0.02))), 1u);
  // Less than 0.1 mm below the surface still counts as on it.
  EXPECT_EQ(leds_seen(carrier(led(-0.01995))), 1u);
  EXPECT_EQ(leds_seen(carrier(led(-0.0198))), 0u);
}

TEST(Cameras, SeeNoDeviceOnTheFarSideOfItsCarrier) {
  EXPECT_EQ(tags_seen(carrier(tag(0.021, "0,90,0"))), 0u);  // it also points away
  EXPECT_EQ(tags_seen(carrier(tag(0.021, "0,-90,0"))), 0u);
  EXPECT_EQ(leds_seen(carrier(led(0.021))), 0u);
  EXPECT_EQ(leds_seen(carrier(led(-0.021))), 1u);
}

TEST(Cameras, SeeNoTagThatIsHalfHidden) {
  const std::string target = carrier(tag(-0.021));
  EXPECT_EQ(tags_seen(target + box("0.3,0.55,0", "0.01,1,0.2")), 1u);
  EXPECT_EQ(tags_seen(target + box("0.3,0.5,0", "0.01,1,0.2")), 0u);        // its left half
  EXPECT_EQ(tags_seen(target + box("0.3,0,0", "0.01,1,0.05")), 0u);         // its lower half
  EXPECT_EQ(tags_seen(target + box("0.3,0,0.052", "0.01,0.003,0.2")), 1u);  // no corner
}

TEST(Cameras, SeeNoLedBehindAThinWall) {
  const std::string target = carrier(led(-0.021));
  EXPECT_EQ(leds_seen(target), 1u);
  EXPECT_EQ(leds_seen(target + box("0.3,0,0", "0.0001,1,0.2")), 0u);
  EXPECT_EQ(leds_seen(target + box("0.3,0,0", "0.0001,1,0.04")), 1u);  // it sees over the wall
  EXPECT_EQ(leds_seen(target + box("0.7,0,0", "0.0001,1,0.2")), 1u);   // the wall is behind the LED
}

TEST(Cameras, AreBlockedByTheirOwnRobotUnlessInsideIt) {
  const auto seen_from = [](const std::string& position) {
    return after_one_tick(carrier(led(-0.021)), cameras(camera("", all_detectors, "c", position)))
        ->observations()
        .leds.size();
  };
  EXPECT_EQ(seen_from("0.06,0,0.05"), 1u);
  EXPECT_EQ(seen_from("-0.06,0,0.05"), 0u);
  EXPECT_EQ(seen_from("0,0,0.05"), 1u);
}

TEST(Cameras, LookThroughTheFloor) {
  Simulation simulation =
      SmallScene{"", cameras(camera()),
                 robot("r", "0,0,0.0", "") + carrier(led(-0.021), "0.5,0,-0.06"), "<floor/>"}
          .run();
  simulation.step();
  EXPECT_EQ(simulation.observations().leds.size(), 1u);
}

TEST(Cameras, ListSixteenOnARobotInOrder) {
  std::string list;
  for (int i = 0; i < 16; ++i) {
    const std::string y = std::to_string(0.001 * i);
    list += camera("", all_detectors, "c" + std::to_string(i), "0.06," + y + ",0.05");
  }
  const auto simulation = after_one_tick(carrier(led(-0.021) + tag(-0.021)), cameras(list));
  const auto& leds = simulation->observations().leds;
  const auto& tags = simulation->observations().tags;
  ASSERT_EQ(leds.size(), 16u);
  ASSERT_EQ(tags.size(), 16u);
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_EQ(leds[i].camera, i);
    EXPECT_EQ(tags[i].camera, i);
    // A camera that is further left sees the same further to the right.
    EXPECT_NEAR(leds[i].center.x(), 320 + 800 * 0.001 * static_cast<double>(i) / 0.419, 1e-6);
  }
}

TEST(Cameras, HaveADetectorOnEachMedium) {
  std::string devices = led(-0.021) + tag(-0.021) +
                        R"(<directional_leds medium="beams"><directional_led anchor="b" )"
                        R"(position="-0.021,0.005,0.02" orientation="0,-90,0" )"
                        R"(observable_angle="90" color="blue"/></directional_leds>)";
  {
    const auto simulation = after_one_tick(carrier(devices));
    EXPECT_EQ(simulation->observations().leds.at(0).color, 0xFF0000u);
    EXPECT_EQ(simulation->observations().directional_leds.at(0).color, 0xFFu);
    EXPECT_EQ(simulation->observations().tags.size(), 1u);
  }
  const std::string only_beams =
      cameras(camera("", R"(<directional_led_detector medium="beams"/>)"));
  const auto simulation = after_one_tick(carrier(devices), only_beams);
  EXPECT_TRUE(simulation->observations().leds.empty());
  EXPECT_EQ(simulation->observations().directional_leds.size(), 1u);
  EXPECT_TRUE(simulation->observations().tags.empty());
}

TEST(Cameras, PublishFrustaAndRaysIfRequested) {
  const std::string arena = carrier(led(-0.021) + tag(-0.021)) + box("0.3,0,0", "0.01,1,0.05");
  const auto silent = after_one_tick(arena);
  EXPECT_TRUE(silent->state().rays.empty());
  EXPECT_TRUE(silent->state().frusta.empty());
  const std::string detectors =
      R"(<led_detector medium="leds" show_rays="true"/><tag_detector medium="tags"/>)";
  const auto shown = after_one_tick(arena, cameras(camera("", detectors), "show_frustum=\"true\""));
  for (int i = 0; i < 2; ++i) {
    ASSERT_EQ(shown->state().frusta.size(), 1u);
    EXPECT_NEAR(shown->state().frusta[0].corners[0].x(), 0.08, 1e-9);
    EXPECT_NEAR(shown->state().frusta[0].corners[6].x(), 2.06, 1e-9);
    EXPECT_NEAR(shown->state().frusta[0].corners[6].y(), -0.8, 1e-9);
    EXPECT_NEAR(shown->state().frusta[0].corners[6].z(), 0.05 - 0.6, 1e-9);
    ASSERT_EQ(shown->state().rays.size(), 1u);
    const world::Ray& ray = shown->state().rays[0];
    EXPECT_EQ(ray.kind, world::Ray::Kind::camera);
    EXPECT_EQ(ray.robot, 0u);
    EXPECT_TRUE(ray.hit);  // at the edge of the wall's top
    EXPECT_NEAR(ray.end.x(), 0.295, 1e-9);
    shown->step();
  }
}

TEST(Cameras, ReadingsAreHashedAndFollowTheLeds) {
  const std::string arena = carrier(led(-0.021) + tag(-0.021));
  const auto with = after_one_tick(arena);
  const auto without = after_one_tick(arena, cameras(camera("", "")));
  EXPECT_NE(with->hash(), without->hash());
  EXPECT_EQ(with->hash(), after_one_tick(arena)->hash());
  ASSERT_EQ(with->observations().leds.size(), 1u);
  with->commands().led_colors.at(0) = 0;
  with->step();
  EXPECT_TRUE(with->observations().leds.empty());
  with->commands().led_colors.at(0) = 0x00FF00;
  with->step();
  EXPECT_EQ(with->observations().leds.at(0).color, 0x00FF00u);
}

/// Lines of sight that a camera looked along in a tick.
std::size_t lines_to(const std::string& arena) {
  const std::string detectors =
      R"(<led_detector medium="leds" show_rays="true"/><tag_detector medium="tags" show_rays="true"/>)";
  return after_one_tick(arena, cameras(camera("", detectors)))->state().rays.size();
}

TEST(LinesOfSight, AreOneForAnLedInViewAndFourForATag) {
  EXPECT_EQ(lines_to(carrier(led(-0.021))), 1u);
  EXPECT_EQ(lines_to(carrier(tag(-0.021))), 4u);
  EXPECT_EQ(lines_to(carrier(led(-0.021) + tag(-0.021))), 5u);
}

TEST(LinesOfSight, AreNoneToWhatIsNotInViewAndEndAtTheFirstHiddenCorner) {
  EXPECT_EQ(lines_to(carrier(tag(0.021, "0,90,0"))), 0u) << "it points away";
  EXPECT_EQ(lines_to(carrier(led(-0.021) + tag(-0.021), "0.5,2,0.03")), 0u) << "beside the picture";
  EXPECT_EQ(lines_to(carrier(led(-0.021) + tag(-0.021), "3,0,0.03")), 0u) << "too far";
  EXPECT_EQ(lines_to(carrier(tag(-0.021)) + box("0.3,0,0", "0.01,1,0.2")), 1u);
}

/// One robot's cameras, and LEDs on one body that all of them see. @returns the ticks that it took
/// before an error, at most two
int ticks_of(int cameras_of_robot, int lit) {
  std::string list, lights = R"(<leds medium="leds">)";
  for (int i = 0; i < cameras_of_robot; ++i) {
    list += camera("", R"(<led_detector medium="leds"/>)", "c" + std::to_string(i));
  }
  for (int i = 0; i < lit; ++i) lights += R"(<led anchor="b" color="red" offset="-0.021,0,0.02"/>)";
  const SmallScene scene{"", cameras(list), robot("r", "0,0,0", "") + carrier(lights + "</leds>"),
                         ""};
  Simulation world(scene.read(), simulation::Options{});
  for (int tick = 0; tick < 2; ++tick) {
    try {
      world.step();
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("write a smaller range"), std::string::npos);
      return tick;
    }
    EXPECT_EQ(world.observations().leds.size(), std::size_t(cameras_of_robot) * std::size_t(lit));
  }
  return 2;
}

TEST(LinesOfSight, AreBoundedInEachTickAndNotInARun) {
  if (!long_runs::takes_all()) GTEST_SKIP() << "seconds: ZIGGURAT_TEST_ALL=1 runs it";
  // Both ticks together need more than one may.
  static_assert(2 * 1024 * 12'000 > world::most_lines_of_sight);
  EXPECT_EQ(ticks_of(1024, 12'000), 2);
  static_assert(1024 * 16'385 > world::most_lines_of_sight);
  EXPECT_EQ(ticks_of(1024, 16'385), 0);
}

TEST(LinesOfSight, OfBlobCamerasAndLightSensorsAreBoundedToo) {
  const scene::Physics nothing;
  const world::Layout layout;
  world::State state;
  world::Observations observations;
  world::Commands commands;
  physics::World bodies(nothing, 0.01);
  const physics::Rays rays(nothing);
  const media::DevicesIndex index(layout);
  devices::Tick tick{layout, state, observations, commands, bodies, rays, index};
  for (std::size_t i = 0; i < world::most_lines_of_sight; ++i) tick.take_line();
  EXPECT_THROW(tick.take_line(), std::runtime_error);
}

TEST(OcclusionTest, TooManyLinesEndWithASentence) {
  const physics::Rays rays(scene::Physics{});
  std::size_t left = 2;
  const devices::OcclusionTest sight{rays, 0, nullptr, nullptr, {}, left};
  for (int line = 0; line < 2; ++line) EXPECT_TRUE(sight.clear({0, 0, 1}, {1, 0, 1}));
  EXPECT_THROW(sight.clear({0, 0, 1}, {1, 0, 1}), std::runtime_error);
}

}  // namespace
}  // namespace ziggurat::camera
