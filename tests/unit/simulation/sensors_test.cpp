// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "small_scene.h"

namespace ziggurat::simulation {
namespace {

using testing::robot;
using testing::SmallScene;
using testing::wheels;

std::string wall(const std::string& position) {
  return R"(<box id="wall" size="0.1,4,4" movable="false"><body position=")" + position +
         R"("/></box>)";
}

std::string ray(const std::string& more = "", const std::string& direction = "1,0,0") {
  return R"(<proximity_sensors><sensor anchor="base" offset="0,0,0.05" direction=")" + direction +
         R"(" range="2" )" + more + "/></proximity_sensors>";
}

std::string proximity(const std::string& more = "") {
  return R"(<proximity implementation="default" )" + more + "/>";
}

double reading(const SmallScene& scene, std::uint64_t seed = 1) {
  Simulation simulation = scene.run(seed);
  EXPECT_EQ(simulation.observations().proximity.at(0), 0);
  simulation.step();
  return simulation.observations().proximity.at(0);
}

TEST(Proximity, ReadsTheExponentialOfTheDistancePastItsOwnBody) {
  const std::string at = robot("r", "0,0,0", ray());
  EXPECT_DOUBLE_EQ(reading({"", proximity(), at + wall("1.03,0,-1"), ""}), std::exp(-0.98));
  EXPECT_EQ(reading({"", proximity(), at + wall("2.06,0,-1"), ""}), 0);
  EXPECT_EQ(reading({"", proximity(), at + wall("-1,0,-1"), ""}), 0);
}

TEST(Proximity, SeesTheFloorOnlyWhereAskedFor) {
  const std::string floor = "<floor/>";
  const auto down = [](const char* more) { return robot("r", "0,0,1", ray(more, "0,0,-1")); };
  EXPECT_EQ(reading({"", proximity(), down(""), floor}), 0);
  EXPECT_DOUBLE_EQ(reading({"", proximity(), down("floor=\"true\""), floor}), std::exp(-1.05));
  EXPECT_DOUBLE_EQ(reading({"", proximity("floor=\"true\""), down(""), floor}), std::exp(-1.05));
  EXPECT_EQ(reading({"", proximity("floor=\"true\""), down("floor=\"false\""), floor}), 0);
}

TEST(Proximity, FollowsTheResponseOfADataSheet) {
  const auto at = [](const char* table, double x) {
    return reading({"", proximity(),
                    robot("r", "0,0,0", ray(std::string("response=\"") + table + "\"")) +
                        wall(std::to_string(x + 0.05) + ",0,-1"),
                    ""});
  };
  EXPECT_NEAR(at("0.5:100, 1:40, 1.5:0", 0.75), 70, 1e-9);
  EXPECT_NEAR(at("0.5:100, 1:40, 1.5:0", 1.25), 20, 1e-9);
  EXPECT_EQ(at("0.5:100, 1:40, 1.5:10", 0.25), 100);
  EXPECT_EQ(at("0.5:100, 1:40, 1.5:10", 1.75), 10);
  EXPECT_EQ(at("0.5:100, 1:40, 1.5:10", 3), 0);  // nothing there
}

TEST(Proximity, DrawsNoiseFromTheRobotsOwnSeededStream) {
  const SmallScene scene{"", proximity("noise_level=\"0.1\""),
                         robot("r", "0,0,0", ray()) + wall("1.05,0,-1"), ""};
  const double first = reading(scene), other = reading(scene, 2);
  EXPECT_EQ(first, reading(scene));
  EXPECT_NE(first, other);
  EXPECT_NE(first, std::exp(-1.0));
  EXPECT_NEAR(first, std::exp(-1.0), 0.1);
  // More robots before it change nothing.
  SmallScene crowded = scene;
  crowded.arena = robot("q", "0,5,0", ray()) + scene.arena;
  Simulation simulation = crowded.run();
  simulation.step();
  EXPECT_EQ(simulation.observations().proximity.at(1), first);
}

TEST(Proximity, PublishesItsRaysIfAsked) {
  const std::string arena = robot("r", "0,0,0", ray()) + wall("1.05,0,-1");
  Simulation silent = SmallScene{"", proximity(), arena, ""}.run();
  silent.step();
  EXPECT_TRUE(silent.state().rays.empty());
  Simulation simulation = SmallScene{"", proximity("show_rays=\"true\""), arena, ""}.run();
  for (int i = 0; i < 2; ++i) simulation.step();
  ASSERT_EQ(simulation.state().rays.size(), 1u);
  EXPECT_TRUE(simulation.state().rays[0].hit);
  EXPECT_NEAR(simulation.state().rays[0].end.x(), 1, 1e-12);
  EXPECT_EQ(silent.state().tick, 1u);
  silent.list_rays(true);  // for viewers
  silent.step();
  EXPECT_EQ(simulation.hash(), silent.hash());
  EXPECT_TRUE(silent.state().rays.empty());
  ASSERT_EQ(silent.rays().size(), 1u);
  EXPECT_EQ(silent.rays()[0].end, simulation.state().rays[0].end);
  EXPECT_TRUE(simulation.rays().empty());
}

std::string bearer(const std::string& medium = "rab", const std::string& more = "") {
  return "<range_and_bearing medium=\"" + medium +
         R"(" anchor="base" position="0,0,0.05" range="3" data_size="2" )" + more + "/>";
}

std::string listening(const std::string& medium, const std::string& more = "") {
  return R"(<range_and_bearing implementation="medium" medium=")" + medium + "\" " + more + "/>";
}

constexpr const char* telling = R"(<range_and_bearing implementation="default"/>)";

TEST(RangeAndBearing, TellsWhereTheOtherIsAndItsDataUntilChanged) {
  Simulation simulation =
      SmallScene{telling, listening("rab"),
                 robot("a", "0,0,0", bearer()) + robot("b", "0,2,0", bearer(), "90,0,0"), ""}
          .run();
  EXPECT_TRUE(simulation.observations().range_and_bearing.empty());
  simulation.commands().range_and_bearing_data = {1, 2, 3, 4};
  for (int tick = 0; tick < 2; ++tick) {
    simulation.step();
    const auto& packets = simulation.observations().range_and_bearing;
    ASSERT_EQ(packets.size(), 2u);
    EXPECT_EQ(packets[0].receiver, 0u);
    EXPECT_NEAR(packets[0].range, 2, 1e-12);
    EXPECT_NEAR(packets[0].horizontal_bearing, M_PI / 2, 1e-12);
    EXPECT_NEAR(packets[0].vertical_bearing, 0, 1e-12);
    EXPECT_EQ(simulation.observations().range_and_bearing_data[packets[0].data.begin], 3);
    // b looks along +y, and a is behind it.
    EXPECT_NEAR(std::abs(packets[1].horizontal_bearing), M_PI, 1e-12);
    EXPECT_EQ(simulation.observations().range_and_bearing_data[packets[1].data.begin + 1], 2);
  }
}

TEST(RangeAndBearing, NeedsSightUnlessTheMediumSaysOtherwise) {
  const auto packets = [](const std::string& medium) {
    Simulation simulation = SmallScene{telling, listening(medium, "show_rays=\"true\""),
                                       robot("a", "-1,0,0", bearer(medium)) +
                                           robot("b", "1,0,0", bearer(medium)) + wall("0,0,-1"),
                                       ""}
                                .run();
    simulation.step();
    EXPECT_EQ(simulation.state().rays.size(), 2u);
    return simulation.observations().range_and_bearing.size();
  };
  EXPECT_EQ(packets("rab"), 0u);
  EXPECT_EQ(packets("through"), 2u);
}

TEST(RangeAndBearing, LosesTheShareThatItShould) {
  const SmallScene scene{telling, listening("rab", R"(packet_drop_prob="0.25")"),
                         robot("a", "-1,0,0", bearer()) + robot("b", "1,0,0", bearer()), ""};
  const auto count = [&](std::uint64_t seed) {
    Simulation simulation = scene.run(seed);
    std::size_t total = 0;
    for (int tick = 0; tick < 1000; ++tick) {
      simulation.step();
      total += simulation.observations().range_and_bearing.size();
    }
    return total;
  };
  EXPECT_NEAR(static_cast<double>(count(1)), 1500, 80);  // four standard deviations
  EXPECT_EQ(count(1), count(1));
}

TEST(RangeAndBearing, NoiseIsOneNormalLengthInADirectionOfTheWorld) {
  // b's +x looks down, so that noise in its own axes would be another.
  Simulation simulation =
      SmallScene{telling, listening("rab", R"(noise_std_dev="0.1")"),
                 robot("a", "1,0,0", bearer()) + robot("b", "0,0,2", bearer(), "0,90,0"), ""}
          .run(3);
  math::Vector3 squares = math::Vector3::Zero(), sum = math::Vector3::Zero();
  constexpr int ticks = 4000;
  for (int tick = 0; tick < ticks; ++tick) {
    simulation.step();
    const auto& packet = simulation.observations().range_and_bearing.at(1);  // of a, at b
    const double level = packet.range * std::cos(packet.vertical_bearing);
    const math::Vector3 seen(level * std::cos(packet.horizontal_bearing),
                             level * std::sin(packet.horizontal_bearing),
                             packet.range * std::sin(packet.vertical_bearing));
    const auto place = [&](std::size_t i) {
      const math::Pose& origin = simulation.state().origins[i];
      return math::Vector3(origin.position + origin.orientation * math::Vector3(0, 0, 0.05));
    };
    const math::Vector3 error =
        place(1) + simulation.state().origins[1].orientation * seen - place(0);
    squares += error.cwiseAbs2();
    sum += error;
  }
  // The mean of cos^2 of a uniform inclination is 1/2. A mean square of a normal number has a
  // deviation of sqrt(2/4000) = 2.2 %, products with sines at most 3.4 %: four of these.
  const math::Vector3 mean = squares / (ticks * 0.01);
  EXPECT_NEAR(mean.sum(), 1, 0.09);
  EXPECT_NEAR(mean.z(), 0.5, 0.07);
  EXPECT_NEAR(mean.x(), 0.25, 0.05);
  EXPECT_NEAR(mean.y(), 0.25, 0.05);
  EXPECT_NEAR(sum.norm() / ticks, 0, 4 * 0.1 / std::sqrt(ticks));
}

TEST(Positioning, IsThePoseOfTheOriginWithNoiseInItsRange) {
  const std::string plain = R"(<positioning implementation="default"/>)";
  const std::string noisy = R"(<positioning implementation="default" pos_noise_range="0.1:0.2"/>)";
  const std::string at = robot("r", "1,2,3", "", "90,0,0");
  Simulation simulation = SmallScene{"", plain, at, ""}.run();
  simulation.step();
  const math::Pose& pose = simulation.observations().positioning.at(0);
  EXPECT_TRUE(pose.position.isApprox(math::Vector3(1, 2, 3)));
  EXPECT_NEAR((pose.orientation * math::Vector3::UnitX()).y(), 1, 1e-12);
  Simulation other = SmallScene{"", noisy, at, ""}.run();
  other.step();
  const math::Vector3 offset =
      other.observations().positioning.at(0).position - math::Vector3(1, 2, 3);
  EXPECT_GE(offset.minCoeff(), 0.1 - 1e-12);
  EXPECT_LE(offset.maxCoeff(), 0.2 + 1e-12);
}

TEST(Positioning, AngleNoiseIsInDegreesAboutTheAxis) {
  Simulation simulation =
      SmallScene{"", R"(<positioning implementation="default" angle_noise_range="-10:20"/>)",
                 robot("r", "0,0,0", "", "90,0,0"), ""}
          .run();
  double sum = 0, least = 1e9, most = -1e9;
  constexpr int ticks = 1000;
  for (int tick = 0; tick < ticks; ++tick) {
    simulation.step();
    const math::Vector3 ahead =
        simulation.observations().positioning.at(0).orientation * math::Vector3::UnitX();
    const double error = std::atan2(ahead.y(), ahead.x()) * 180 / M_PI - 90;
    EXPECT_NEAR(ahead.z(), 0, 1e-12);
    sum += error;
    least = std::min(least, error);
    most = std::max(most, error);
  }
  EXPECT_GE(least, -10 - 1e-9);
  EXPECT_LE(most, 20 + 1e-9);
  EXPECT_NEAR(sum / ticks, 5, 4 * 30 / std::sqrt(12.0 * ticks));
}

TEST(Positioning, OfATurningRobotIsTheQuaternionThatTurnsByLessThanPi) {
  const std::string turning = R"(<foot-bot id="f"><body/><controller config="c"/></foot-bot>)";
  Simulation simulation =
      SmallScene{wheels, R"(<positioning implementation="default"/>)", turning, testing::ground}
          .run();
  simulation.commands().wheels.assign(1, {-0.1, 0.1});  // 0.14 m apart: 1.43 rad/s
  bool is_over_half = false;
  for (int tick = 0; tick < 100; ++tick) {
    simulation.step();
    const math::Quaternion& q = simulation.observations().positioning.at(0).orientation;
    EXPECT_GE(q.w(), 0);
    EXPECT_TRUE(q.isApprox(math::canonical(simulation.state().origins[0].orientation)));
    is_over_half |= simulation.state().origins[0].orientation.w() < 0;
  }
  EXPECT_TRUE(is_over_half);
}

TEST(Battery, LosesItsFactorAtEveryTick) {
  const std::string devices =
      R"(<battery discharge_model="time" full_charge="10" start_charge="5" factor="0.2"/>)";
  Simulation simulation =
      SmallScene{"", R"(<battery implementation="default"/>)", robot("r", "0,0,0", devices), ""}
          .run();
  const auto& battery = simulation.observations().batteries.at(0);
  EXPECT_DOUBLE_EQ(battery.available_charge, 0.5);
  EXPECT_DOUBLE_EQ(battery.time_left, 2.5);
  for (int tick = 0; tick < 10; ++tick) simulation.step();  // a second
  EXPECT_NEAR(battery.available_charge, 0.3, 1e-12);
  EXPECT_NEAR(battery.time_left, 1.5, 1e-9);
  for (int tick = 0; tick < 20; ++tick) simulation.step();
  EXPECT_EQ(battery.available_charge, 0);
  EXPECT_EQ(battery.time_left, 0);
}

TEST(Battery, LosesTheDialectsFactorsWhereTheSceneHasNone) {
  const auto charge = [](const std::string& battery, const std::string& engine = "") {
    Simulation simulation = SmallScene{"", R"(<battery implementation="default"/>)",
                                       robot("r", "0,0,0", battery), engine}
                                .run();
    testing::run(simulation, 10);
    return std::pair(simulation.observations().batteries.at(0).available_charge,
                     -simulation.state().origins[0].position.z());
  };
  EXPECT_NEAR(charge("<battery/>").first, 1 - 10e-5, 1e-15);
  const auto [left, depth] =
      charge(R"(<battery discharge_model="time_motion"/>)", R"(<gravity g="10"/>)");
  EXPECT_NEAR(left, 1 - 10e-5 - depth * 1e-3, 1e-12);
}

TEST(Battery, ReadsWithUniformNoiseWithinNoneAndAll) {
  const auto readings = [](const std::string& battery) {
    Simulation simulation =
        SmallScene{"", R"(<battery implementation="default" noise_range="-0.1:0.3"/>)",
                   robot("r", "0,0,0", battery), ""}
            .run();
    std::vector<double> result;
    for (int tick = 0; tick < 1000; ++tick) {
      simulation.step();
      result.push_back(simulation.observations().batteries.at(0).available_charge);
    }
    return result;
  };
  const auto half = readings(R"(<battery start_charge="0.5" factor="0"/>)");
  EXPECT_GE(*std::ranges::min_element(half), 0.4);
  EXPECT_LE(*std::ranges::max_element(half), 0.8);
  const double mean = std::accumulate(half.begin(), half.end(), 0.0) / 1000;
  EXPECT_NEAR(mean, 0.6, 4 * 0.4 / std::sqrt(12 * 1000));
  const auto full = readings(R"(<battery factor="0"/>)");
  EXPECT_EQ(*std::ranges::max_element(full), 1);
}

TEST(Battery, LosesChargeWithMotionOnlyWhenThereIsAny) {
  const std::string devices =
      R"(<battery discharge_model="motion" full_charge="10" factor="2" pos_factor="1"/>)";
  const std::string sensor = R"(<battery implementation="default"/>)";
  Simulation still = SmallScene{"", sensor, robot("r", "0,0,0", devices), ""}.run();
  still.step();
  EXPECT_EQ(still.observations().batteries.at(0).available_charge, 1);
  EXPECT_EQ(still.observations().batteries.at(0).time_left,
            std::numeric_limits<double>::infinity());
  Simulation falling =
      SmallScene{"", sensor, robot("r", "0,0,0", devices), R"(<gravity g="10"/>)"}.run();
  for (int tick = 0; tick < 5; ++tick) falling.step();
  const double depth = -falling.state().origins[0].position.z();
  EXPECT_GT(depth, 0.5);
  EXPECT_NEAR(falling.observations().batteries.at(0).available_charge, 1 - depth / 10, 1e-9);
}

}  // namespace
}  // namespace ziggurat::simulation
