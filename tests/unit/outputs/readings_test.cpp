// SPDX-License-Identifier: MIT
#include "outputs/readings.h"

#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "file_text.h"
#include "ziggurat/v1/recording.pb.h"

namespace ziggurat::outputs {
namespace {

/// Two robots: the first with everything, the second with a joint.
world::Layout layout() {
  world::Layout layout;
  layout.entities = {{"r0", {0, 1}, true, {0, 2}, {0, 1}, {0, 1}}, {"r1", {1, 1}, true}};
  layout.links = {{"base", 0}, {"base", 1}};
  layout.robots.resize(2);
  layout.robots[0].id = "r0";
  layout.robots[0].joint_sensors = {0, 2};
  layout.robots[0].joint_actuators = {0, 1};
  layout.robots[1].id = "r1";
  layout.robots[1].entity = 1;
  layout.robots[1].joint_sensors = {2, 1};
  layout.robots[1].joint_actuators = {1, 1};
  layout.joint_sensors = {{"right"}, {"left"}, {"arm"}};
  layout.joint_actuators = {{"right"}, {"arm"}};
  return layout;
}

void add_devices(world::Layout& layout) {
  world::RobotLayout& robot = layout.robots[0];
  robot.radios = {0, 2};
  layout.radios.resize(2);
  layout.radios[0].id = "rx";
  layout.radios[0].receives = true;
  layout.radios[1].id = "tx";
  layout.radios[1].sends = true;
  robot.leds = {0, 2};
  layout.leds.resize(2);
  robot.magnets = {0, 1};
  layout.magnets.resize(1);
  layout.magnets[0].id = "coil";
  robot.proximity = {0, 2};
  robot.range_and_bearing = {0, 1};
  layout.range_and_bearing.resize(1);
  layout.range_and_bearing[0].data = {0, 2};
  layout.range_and_bearing[0].sends = layout.range_and_bearing[0].receives = true;
  robot.positioning = {0, 1};
  robot.batteries = {0, 1};
}

struct World {
  world::State state;
  world::Observations observations;
  world::Commands commands;
};

World joints_only(std::uint64_t tick, std::vector<double> readings, std::vector<double> targets) {
  World world;
  world.state.led_colors = {0xFF0010, 0};
  world.state.directional_led_colors = {0x00FF00};
  world.state.tag_payloads = {"block\xFF"};
  world.observations.tick = tick;
  world.observations.time_ns = static_cast<std::int64_t>(tick) * 100'000'000;
  world.observations.joint_readings = std::move(readings);
  world.commands.joint_targets = std::move(targets);
  return world;
}

std::vector<v1::Reading> read_back(const std::string& text) {
  std::istringstream lines(text);
  std::vector<v1::Reading> read;
  for (std::string line; std::getline(lines, line);) {
    EXPECT_TRUE(google::protobuf::util::JsonStringToMessage(line, &read.emplace_back()).ok())
        << line;
  }
  return read;
}

TEST(Readings, HasALinePerRobotInSceneOrderWithNamesOfTheProto) {
  const auto path = scratch("jsonl");
  const auto robots = layout();
  Readings readings(path, robots);
  const World world = joints_only(3, {0.5, 0.25, 0}, {1.5, -2});
  readings.write(world.state, world.observations, world.commands);
  readings.close();
  std::istringstream lines(text_of(path));
  std::string first, second;
  std::getline(lines, first);
  std::getline(lines, second);
  const auto begins = [](const std::string& line, const std::string& start) {
    EXPECT_EQ(line.substr(0, start.size()), start);
  };
  begins(first, R"({"tick":"3","time_s":0.3,"robot":"r0",)"
                R"("observation":{"joint_encoders":{"left":0.25,"right":0.5},)");
  begins(second, R"({"tick":"3","time_s":0.3,"robot":"r1",)"
                 R"("observation":{"joint_encoders":{"arm":0},)");
  EXPECT_NE(second.find(R"("command":{"joint_targets":{"arm":-2})"), std::string::npos) << second;
}

TEST(Readings, HasALineOfADirectorThatSetMetrics) {
  const auto path = scratch("jsonl");
  const auto robots = layout();
  Readings readings(path, robots);
  const World world = joints_only(3, {0.5, 0.25, 0}, {1.5, -2});
  readings.write(world.state, world.observations, world.commands,
                 {{"r1", "blocks", 2}, {"judge", "gap", 0.5}, {"judge", "blocks", 4}});
  readings.close();
  std::istringstream lines(text_of(path));
  std::vector<std::string> all;
  for (std::string line; std::getline(lines, line);) all.push_back(line);
  ASSERT_EQ(all.size(), 3u);
  EXPECT_NE(all[0].find(R"("metrics":{})"), std::string::npos) << all[0];
  EXPECT_NE(all[1].find(R"("metrics":{"blocks":2})"), std::string::npos) << all[1];
  EXPECT_EQ(all[2],
            R"({"tick":"3","time_s":0.3,"robot":"judge","metrics":{"blocks":4,"gap":0.5}})");
}

TEST(Readings, NamesEveryDevice) {
  const auto path = scratch("jsonl");
  auto robots = layout();
  add_devices(robots);
  World world = joints_only(1, {0, 0, 0}, {0, 0});
  const std::vector<std::uint8_t> hello{1, 255}, none;
  world.observations.radio_messages.add(0, hello);
  world.observations.radio_messages.add(0, none);
  world.observations.proximity = {0, 0.5};
  world.observations.range_and_bearing = {{0, 2.5, 0.25, -0.5, {0, 2}}};
  world.observations.range_and_bearing_data = {7, 8};
  world.observations.positioning.resize(1);
  world.observations.positioning[0].position = {1, 2, 3};
  world.observations.batteries = {{0.75, 30}};
  robots.imus = {{"imu", {}}};
  robots.robots[0].imus = {0, 1};
  robots.contact_sensors = {{"skin", "base", 0, 0}};
  robots.robots[0].contact_sensors = {0, 1};
  world.observations.contact_sensors = {{1, {2, 3, 4}, 9}};
  world.observations.imus = {{{1, 2, 3}, {4, 5, 6}}};
  world.commands.radio_messages.add(1, hello);
  world.commands.led_colors = {0, 0x0000FF};
  world.commands.magnet_currents = {-1.5};
  world.commands.range_and_bearing_data = {9, 10};
  Readings readings(path, robots);
  readings.write(world.state, world.observations, world.commands);
  readings.close();
  const auto read = read_back(text_of(path));
  ASSERT_EQ(read.size(), 2u);
  const v1::RobotObservation& sensed = read[0].observation();
  ASSERT_EQ(sensed.radio_messages().size(), 1u);  // tx only sends
  ASSERT_EQ(sensed.radio_messages().at("rx").messages_size(), 2);
  EXPECT_EQ(sensed.radio_messages().at("rx").messages(0).bytes(1), 255u);
  EXPECT_EQ(sensed.radio_messages().at("rx").messages(1).bytes_size(), 0);
  EXPECT_EQ(sensed.proximity(1), 0.5);
  EXPECT_EQ(sensed.range_and_bearing(0).vertical_bearing(), -0.5);
  EXPECT_EQ(sensed.range_and_bearing(0).data(1), 8u);
  EXPECT_EQ(sensed.positioning().z(), 3);
  EXPECT_EQ(sensed.battery().available_charge(), 0.75);
  EXPECT_EQ(sensed.contact_sensors().at("skin").touches(), 1);
  EXPECT_EQ(sensed.contact_sensors().at("skin").force_z(), 4);
  EXPECT_EQ(sensed.contact_sensors().at("skin").strength(), 9);
  EXPECT_EQ(sensed.imus().at("imu").acceleration_z(), 3);
  EXPECT_EQ(sensed.imus().at("imu").angular_velocity_x(), 4);
  EXPECT_EQ(sensed.led_colors(0).red(), 255u);
  EXPECT_EQ(sensed.led_colors(0).blue(), 16u);
  EXPECT_EQ(sensed.directional_led_colors(0).green(), 255u);
  EXPECT_EQ(sensed.tag_payloads(0).substr(0, 5), "block");
  const v1::RobotCommand& command = read[0].command();
  ASSERT_EQ(command.radio_messages().size(), 1u);
  EXPECT_EQ(command.radio_messages().at("tx").messages(0).bytes(0), 1u);
  EXPECT_EQ(command.led_colors(1).blue(), 255u);
  EXPECT_EQ(command.magnet_currents().at("coil"), -1.5);
  EXPECT_EQ(command.range_and_bearing_data(1), 10u);
  EXPECT_EQ(read[1].observation().led_colors_size(), 0);
}

TEST(Readings, NamesDetectionsOfCameras) {
  const auto path = scratch("jsonl");
  auto robots = layout();
  robots.robots[0].cameras = {0, 1};
  robots.robots[1].cameras = {1, 2};
  robots.cameras.resize(3);
  for (std::size_t i = 0; i < 3; ++i) robots.cameras[i].id = "camera" + std::to_string(i);
  World world = joints_only(1, {0, 0, 0}, {0, 0});
  world.observations.leds = {{0, 0xFF0010, {1, 2}}, {2, 0x0000FF, {3, 4}}, {2, 0x00FF00, {5, 6}}};
  world.observations.directional_leds = {{2, 0x010203, {7, 8}}};
  world.observations.tags = {{1, 0, {9, 10}, {{{1, 2}, {3, 4}, {5, 6}, {7, 8}}}}};
  Readings readings(path, robots);
  readings.write(world.state, world.observations, world.commands);
  readings.close();
  const auto read = read_back(text_of(path));
  ASSERT_EQ(read.size(), 2u);
  ASSERT_EQ(read[0].observation().cameras().size(), 1u);
  const v1::CameraReading& first = read[0].observation().cameras().at("camera0");
  ASSERT_EQ(first.leds_size(), 1);
  EXPECT_EQ(first.leds(0).color().blue(), 16u);
  EXPECT_EQ(first.leds(0).center().v(), 2);
  const auto& others = read[1].observation().cameras();
  ASSERT_EQ(others.size(), 2u);
  ASSERT_EQ(others.at("camera1").tags_size(), 1);
  const v1::SeenTag& tag = others.at("camera1").tags(0);
  EXPECT_EQ(tag.payload().substr(0, 5), "block");
  EXPECT_EQ(tag.center().u(), 9);
  ASSERT_EQ(tag.corners_size(), 4);
  EXPECT_EQ(tag.corners(3).u(), 7);
  EXPECT_EQ(others.at("camera2").leds_size(), 2);
  EXPECT_EQ(others.at("camera2").leds(1).center().u(), 5);
  EXPECT_EQ(others.at("camera2").directional_leds(0).color().red(), 1u);
  EXPECT_EQ(others.at("camera2").tags_size(), 0);
}

TEST(Readings, NamesWheelsAndTurrets) {
  const auto path = scratch("jsonl");
  auto robots = layout();
  robots.robots[0].wheels = robots.robots[0].turrets = {0, 1};
  robots.robots[1].wheels = robots.robots[1].turrets = {1, 1};
  robots.wheels = {{0, 0.14, true, false}, {1, 0.14, false, true}};
  robots.turrets = {{0, true, false}, {1, false, true}};
  World world = joints_only(1, {0, 0, 0}, {0, 0});
  world.observations.wheels = {{}, {1, 2, 3, 4}};
  world.observations.turrets = {9, -0.5};
  world.commands.wheels = {{0.25, -0.5}, {}};
  world.commands.turret_modes = {world::TurretMode::speed, world::TurretMode::passive};
  world.commands.turret_rotations = {1, 0};
  world.commands.turret_speeds = {2, 0};
  Readings readings(path, robots);
  readings.write(world.state, world.observations, world.commands);
  readings.close();
  const auto read = read_back(text_of(path));
  ASSERT_EQ(read.size(), 2u);
  EXPECT_FALSE(read[0].observation().has_wheels() || read[0].observation().has_turret_rotation());
  EXPECT_EQ(read[0].command().wheels().left(), 0.25);
  EXPECT_EQ(read[0].command().wheels().right(), -0.5);
  EXPECT_EQ(read[0].command().turret().mode(), "speed");
  EXPECT_EQ(read[0].command().turret().rotation(), 1);
  EXPECT_EQ(read[0].command().turret().speed(), 2);
  EXPECT_EQ(read[1].observation().wheels().distance_right(), 4);
  EXPECT_EQ(read[1].observation().turret_rotation(), -0.5);
  EXPECT_FALSE(read[1].command().has_wheels() || read[1].command().has_turret());
}

TEST(Readings, ReadBackAsTheSameMessage) {
  const auto path = scratch("jsonl");
  const auto robots = layout();
  Readings readings(path, robots);
  const World world = joints_only(1, {0.1 + 0.2, 1.0 / 3, 5e-324}, {1e22, -0.0});
  readings.write(world.state, world.observations, world.commands);
  readings.close();
  const auto read = read_back(text_of(path));
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[0].observation().joint_encoders().at("right"), 0.1 + 0.2);
  EXPECT_EQ(read[0].observation().joint_encoders().at("left"), 1.0 / 3);
  EXPECT_EQ(read[1].observation().joint_encoders().at("arm"), 5e-324);
  EXPECT_EQ(read[0].command().joint_targets().at("right"), 1e22);
}

}  // namespace
}  // namespace ziggurat::outputs
