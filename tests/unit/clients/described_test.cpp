// SPDX-License-Identifier: MIT
// Devices that describe themselves: the C++ handles and the tables of Lua.

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "lua_devices.h"

namespace ziggurat::lua::described {
namespace {

v1::DeviceKind& add_kind(v1::RobotDescription& robot, const char* name,
                         std::initializer_list<const char*> readings, int devices) {
  v1::DeviceKind& kind = *robot.add_device_kinds();
  kind.set_name(name);
  for (const char* reading : readings) kind.add_readings()->set_name(reading);
  for (int i = 0; i < devices; ++i) kind.add_devices()->set_anchor("origin");
  return kind;
}

void add_command(v1::DeviceKind& kind, const char* name, double least, double most,
                 double initial = 0) {
  v1::DeviceCommand& command = *kind.add_commands();
  command.set_name(name);
  command.set_least(least);
  command.set_most(most);
  command.set_initial(initial);
}

/// Two lamps "left" and "right" and an ear.
class Described : public Devices {
 protected:
  Described() {
    v1::DeviceKind& lamp = add_kind(robot_, "lamp", {"value", "heat"}, 2);
    lamp.add_properties()->set_name("angle");
    add_command(lamp, "power", -1, 1, 0.5);
    lamp.mutable_devices(0)->set_id("left");
    lamp.mutable_devices(1)->set_id("right");
    for (auto& device : *lamp.mutable_devices()) {
      device.add_properties(0.75);
      for (const double value : {1.0, 2.0, 3.0}) device.add_position(value);
    }
    v1::DeviceKind& ear = add_kind(robot_, "ear", {"pitch", "color"}, 1);
    ear.set_most_rows(9);
    ear.mutable_readings(1)->set_unit("0xRRGGBB");
    add_kind(robot_, "plain", {"value"}, 3);
  }
  void see() {
    seen().clear_device_readings();
    seen().clear_device_rows();
    for (const double value : {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0})
      seen().add_device_readings(value);
    seen().add_device_rows(2);
    for (const double value : {440.0, 255.0 * 65536, 880.0, 255.0})
      seen().add_device_row_values(value);
  }
};

TEST_F(Described, HandlesReadByName) {
  EXPECT_RUNS(start("function step() end"));
  see();
  EXPECT_RUNS(step());
  ASSERT_EQ(robot().devices("lamp").size(), 2u);
  EXPECT_TRUE(robot().devices("torch").empty());
  EXPECT_EQ(robot().devices().size(), 6u);
  Device& right = robot().device("lamp", "right");
  EXPECT_EQ(right.reading("value"), 3);
  EXPECT_EQ(right.reading("heat"), 4);
  EXPECT_EQ(right.property("angle"), 0.75);
  EXPECT_EQ(right.position()[2], 3);
  EXPECT_EQ(robot().devices("plain")[2].readings()[0], 7);
  const Device& ear = robot().devices("ear")[0];
  ASSERT_EQ(ear.row_count(), 2u);
  EXPECT_EQ(ear.row(1)[0], 880);
  EXPECT_TRUE(ear.readings().empty());
  EXPECT_THROW(right.reading("colour"), std::out_of_range);
  EXPECT_THROW(ear.reading("pitch"), std::out_of_range);
  EXPECT_THROW(robot().device("lamp", "middle"), std::out_of_range);
}

TEST_F(Described, CommandsAreCheckedAndSentTogether) {
  EXPECT_RUNS(start("function step() end"));
  Device& right = robot().device("lamp", "right");
  EXPECT_EQ(right.commanded("power"), 0.5);
  EXPECT_EQ(command().device_commands_size(), 0);
  right.set("power", -1);
  for (const double bad : {1.5, -2.0, static_cast<double>(NAN)})
    EXPECT_THROW(right.set("power", bad), std::invalid_argument);
  EXPECT_THROW(right.set("colour", 1), std::out_of_range);
  const v1::Command sent = command();
  ASSERT_EQ(sent.device_commands_size(), 2);
  EXPECT_EQ(sent.device_commands(0), 0.5);
  EXPECT_EQ(sent.device_commands(1), -1);
}

TEST_F(Described, ReadingsOfAnotherLengthAreRefused) {
  EXPECT_RUNS(start("function step() end"));
  see();
  seen().add_device_row_values(1);
  EXPECT_THROW(step(), std::runtime_error);
}

TEST_F(Described, LuaTablesFollowFromTheDescription) {
  EXPECT_RUNS(start(R"lua(
    left, ear, plain = robot.lamp.left, robot.ear, robot.plain
    assert(left.angle == 0.75 and left.value == 0 and #robot.lamp == 0)
    assert(#ear == 0 and #plain == 3 and plain[3] == 0)
    left.set_power(1)
    refused("power of lamp is 2", left.set_power, 2)
    refused("set_", left.set_power)
    function step()
      assert(left.value == 1 and left.heat == 2 and robot.lamp.right.heat == 4)
      assert(plain[1] == 5 and plain[2] == 6 and plain[3] == 7)
      assert(#ear == rows)
      if rows == 2 then
        assert(ear[1].pitch == 440 and ear[1].color.red == 255 and ear[1].color.green == 0)
        assert(ear[2].pitch == 880 and ear[2].color.blue == 255)
      end
      rows = 0
    end
    rows = 2
  )lua"));
  EXPECT_EQ(command().device_commands(0), 1);
  see();
  EXPECT_RUNS(step());
  seen().clear_device_row_values();
  seen().set_device_rows(0, 0);
  EXPECT_RUNS(step());
}

TEST_F(Devices, LuaLightsHaveTheShapeOfTheDialect) {
  v1::DeviceKind& light = add_kind(robot_, "footbot_light", {"value"}, 2);
  light.add_properties()->set_name("angle");
  light.mutable_devices(0)->add_properties(0.125);
  light.mutable_devices(1)->add_properties(-0.125);
  v1::DeviceKind& ground = add_kind(robot_, "footbot_motor_ground", {"value"}, 1);
  for (const char* name : {"offset_x", "offset_y"}) ground.add_properties()->set_name(name);
  for (const double value : {0.063, -0.0116}) ground.mutable_devices(0)->add_properties(value);
  EXPECT_RUNS(start(R"lua(
    assert(robot.light[1].angle == 0.125 and robot.light[2].angle == -0.125)
    local offset = robot.motor_ground[1].offset
    assert(math.abs(offset.x - 6.3) < 1e-12 and math.abs(offset.y + 1.16) < 1e-12)
    function step() assert(robot.light[2].value == 0.5 and robot.motor_ground[1].value == 1) end
  )lua"));
  seen().clear_device_readings();
  for (const double value : {0.25, 0.5, 1.0}) seen().add_device_readings(value);
  EXPECT_RUNS(step());
}

TEST_F(Devices, LuaScannersHaveTheShapeOfTheDialect) {
  v1::DeviceKind& kind =
      add_kind(robot_, "footbot_distance_scanner", {"angle", "distance", "is_long"}, 1);
  kind.set_most_rows(24);
  add_command(kind, "mode", 0, 2);
  add_command(kind, "angle", -INFINITY, INFINITY);
  add_command(kind, "speed", -INFINITY, INFINITY);
  EXPECT_RUNS(start(R"lua(
    short, long = robot.distance_scanner.short_range, robot.distance_scanner.long_range
    assert(#short == 0 and #long == 0)
    robot.distance_scanner.set_rpm(30)
    function step()
      assert(#short == 1 and #long == 2)
      assert(short[1].angle == 0.5 and short[1].distance == 20 and short[1].is_long == nil)
      assert(long[1].distance == -2 and long[2].distance == -1)
      robot.distance_scanner.set_angle(0.25)
    end
  )lua"));
  const v1::Command turning = command();
  ASSERT_EQ(turning.device_commands_size(), 3);
  EXPECT_EQ(turning.device_commands(0), 2);
  EXPECT_NEAR(turning.device_commands(2), M_PI, 1e-12);
  seen().set_device_rows(0, 3);
  for (const double value : {0.5, 0.2, 0.0, -1.0, -0.02, 1.0, 1.0, -0.01, 1.0})
    seen().add_device_row_values(value);
  EXPECT_RUNS(step());
  const v1::Command pointing = command();
  EXPECT_EQ(pointing.device_commands(0), 1);
  EXPECT_EQ(pointing.device_commands(1), 0.25);
}

TEST_F(Devices, LuaQuadrotorsTakeOrders) {
  v1::DeviceKind& kind = add_kind(robot_, "quadrotor", {}, 1);
  for (const char* name : {"move_mode", "x", "y", "z", "moves", "velocity_x", "velocity_y",
                           "velocity_z", "turn_mode", "yaw", "turns", "yaw_rate"}) {
    add_command(kind, name, -INFINITY, INFINITY);
  }
  EXPECT_RUNS(start(R"lua(
    robot.quadrotor.set_absolute_position(1, 2, 3)
    robot.quadrotor.set_absolute_yaw(90)
    function step()
      robot.quadrotor.set_relative_position({4, 5, 6})
      robot.quadrotor.set_relative_position(4, 5, 6)
      robot.quadrotor.set_rotational_speed(0.5)
      local done, why = pcall(robot.quadrotor.set_linear_velocity, 1, 2)
      assert(not done and why:find("set_linear_velocity(x, y, z)", 1, true), why)
    end
  )lua"));
  const auto orders = [&] {
    const v1::Command given = command();
    return std::vector<double>(given.device_commands().begin(), given.device_commands().end());
  };
  EXPECT_EQ(orders(), std::vector<double>({1, 1, 2, 3, 0, 0, 0, 0, 1, 90 * M_PI / 180, 0, 0}));
  EXPECT_RUNS(step());
  EXPECT_EQ(orders(), std::vector<double>({2, 4, 5, 6, 2, 0, 0, 0, 3, 90 * M_PI / 180, 0, 0.5}));
}

TEST_F(Devices, LuaBlobCamerasAreSwitched) {
  v1::DeviceKind& kind =
      add_kind(robot_, "colored_blob_omnidirectional_camera", {"distance", "angle", "color"}, 1);
  kind.set_most_rows(99);
  kind.mutable_readings(2)->set_unit("0xRRGGBB");
  kind.add_properties()->set_name("aperture");
  kind.mutable_devices(0)->add_properties(1.2);
  add_command(kind, "enabled", 0, 1);
  EXPECT_RUNS(start(R"lua(
    local camera = robot.colored_blob_omnidirectional_camera
    camera.enable()
    refused("enable()", camera.enable, 1)
    function step()
      assert(#camera == 1 and camera[1].distance == 50 and camera[1].angle == 1)
      assert(camera[1].color.green == 255 and camera[1].color.red == 0)
      camera.disable()
    end
  )lua"));
  EXPECT_EQ(command().device_commands(0), 1);
  seen().set_device_rows(0, 1);
  for (const double value : {0.5, 1.0, 255.0 * 256}) seen().add_device_row_values(value);
  EXPECT_RUNS(step());
  EXPECT_EQ(command().device_commands(0), 0);
}

}  // namespace
}  // namespace ziggurat::lua::described
