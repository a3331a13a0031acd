// SPDX-License-Identifier: MIT
// Tables below `robot` in scripts, one by one. A script's fault fails its assert.

#include "lua_devices.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "script/colors.h"

namespace ziggurat::lua {
namespace {

void assign(google::protobuf::RepeatedField<double>& to, std::initializer_list<double> values) {
  to.Clear();
  to.Add(values.begin(), values.end());
}

// ---- presence -----------------------------------------------------------------------------------

TEST_F(Devices, ExistOnlyIfTheControllerHasThem) {
  EXPECT_RUNS(start(R"lua(
    local all = {id = true, params = true, random = true, first_tick = true, metric = true}
    for name in pairs(robot) do assert(all[name], name) end
  )lua"));
}

TEST_F(Devices, HaveTheFunctionsAndReadingsThatAreEnabled) {
  add_radio(robot_, "ears", {.receives = true});
  add_radio(robot_, "mouth", {.sends = true});
  robot_.mutable_range_and_bearing()->set_receives(true);
  EXPECT_RUNS(start(R"lua(
    assert(robot.radios.ears.tx_data == nil and #robot.radios.ears.rx_data == 0)
    assert(robot.radios.mouth.rx_data == nil and robot.radios.mouth.tx_data)
    assert(robot.range_and_bearing.set_data == nil and #robot.range_and_bearing == 0)
    local names = {}
    for name, radio in pairs(robot.radios) do
      names[#names + 1] = name
      assert(type(radio) == "table")
    end
    assert(table.concat(names, " ") == "ears mouth")
  )lua"));
}

// ---- memory -------------------------------------------------------------------------------------

TEST_F(Devices, ATickOfSensorsWithFixedReadingsMakesNoGarbage) {
  add_driving(robot_);
  robot_.set_positioning(true);
  robot_.set_battery(true);
  robot_.add_proximity_sensors();
  robot_.add_proximity_sensors()->set_angle(0.5);
  robot_.add_imus()->set_id("imu");
  robot_.add_contact_sensors()->set_id("skin");
  v1::JointDescription& joint = *robot_.add_joint_sensors();
  joint.set_id("arm");
  joint.set_mode(v1::JointDescription::POSITION);
  EXPECT_RUNS(start(R"lua(
    function init() collectgarbage() collectgarbage("stop") end
    local count, least = 0, nil
    function step()
      robot.wheels.set_velocity(robot.wheels.velocity_left, 3)
      count = count + robot.proximity[1] + robot.joints.arm.encoder + robot.positioning.position.x
      local now = collectgarbage("count")
      assert(least == nil or now == least, now)
      least = now
    end
  )lua"));
  assign(*seen().mutable_joint_readings(), {1.5});
  assign(*seen().mutable_proximity(), {0.25, 0.5});
  assign(*seen().mutable_positioning(), {1, 2, 3, 1, 0, 0, 0});
  assign(*seen().mutable_batteries(), {1, 2});
  assign(*seen().mutable_imus(), {1, 2, 3, 4, 5, 6});
  assign(*seen().mutable_contact_sensors(), {1, 2, 3, 4, 5});
  assign(*seen().mutable_wheels(), {1, 2, 3, 4});
  assign(*seen().mutable_turret_rotations(), {0.5});
  for (int tick = 0; tick < 100; ++tick) EXPECT_RUNS(step());
}

// ---- LEDs ---------------------------------------------------------------------------------------

TEST_F(Devices, AJointHasASensorOfItsPositionAndOneOfItsVelocity) {
  using Description = v1::JointDescription;
  for (const auto& [id, mode] :
       {std::pair{"arm", Description::VELOCITY}, std::pair{"arm", Description::POSITION},
        std::pair{"leg", Description::POSITION}}) {
    v1::JointDescription& sensor = *robot_.add_joint_sensors();
    sensor.set_id(id);
    sensor.set_mode(mode);
  }
  EXPECT_RUNS(start(R"lua(
    function step()
      local arm, leg = robot.joints.arm, robot.joints.leg
      assert(#robot.joints == 0 and arm.velocity == 1 and arm.position == 2 and arm.encoder == 1)
      assert(leg.position == 3 and leg.velocity == nil and leg.encoder == 3)
    end
  )lua"));
  for (int i = 0; i < 3; ++i) seen().set_joint_readings(i, i + 1);
  EXPECT_RUNS(step());
  ASSERT_EQ(robot().joints().size(), 2U);
  EXPECT_EQ(robot().joint("arm").velocity(), 1);
  EXPECT_EQ(robot().joint("arm").position(), 2);
  EXPECT_EQ(robot().joint("arm").encoder_mode(), JointMode::velocity);
  EXPECT_FALSE(robot().joint("leg").has_velocity());
  EXPECT_THROW(robot().joint("leg").velocity(), std::logic_error);
}

TEST_F(Devices, LedColorsInAllForms) {
  for (int i = 0; i < 6; ++i) robot_.add_leds()->set_color(0x010101);
  EXPECT_RUNS(start(R"lua(
    local set = robot.leds.set_single_color
    set(1, "red")
    set(2, "1,2,3,4")
    set(3.9, 10, 20.9, 300)
    set(4, " 4 , 5, 6,255")
    set(5, -1, 256, 0)
  )lua"));
  const auto leds = robot().leds();
  EXPECT_EQ(leds[0].color(), (Color{255, 0, 0}));
  EXPECT_EQ(leds[1].color(), (Color{1, 2, 3}));
  EXPECT_EQ(leds[2].color(), (Color{10, 20, 44}));
  EXPECT_EQ(leds[3].color(), (Color{4, 5, 6}));
  EXPECT_EQ(leds[4].color(), (Color{255, 0, 0}));
  EXPECT_EQ(leds[5].color(), (Color{1, 1, 1})) << "the scene's color stays";
  EXPECT_EQ(command().led_colors_size(), 6);
}

TEST_F(Devices, AllLedsAtOnceAndEachKindByItself) {
  for (int i = 0; i < 3; ++i) robot_.add_leds();
  for (int i = 0; i < 2; ++i) robot_.add_directional_leds();
  EXPECT_RUNS(start(R"lua(
    robot.leds.set_all_colors(255,0,0)
    robot.directional_leds.set_all_colors("gray40")
    robot.directional_leds.set_single_color(2, 1, 2, 3)
  )lua"));
  for (const Led& led : robot().leds()) EXPECT_EQ(led.color(), (Color{255, 0, 0}));
  EXPECT_EQ(robot().directional_leds()[0].color(), (Color{102, 102, 102}));
  EXPECT_EQ(robot().directional_leds()[1].color(), (Color{1, 2, 3}));
}

TEST_F(Devices, LedsRefuseInvalidColorsAndPositions) {
  for (int i = 0; i < 2; ++i) robot_.add_leds();
  EXPECT_RUNS(start(R"lua(
    local one, all = robot.leds.set_single_color, robot.leds.set_all_colors
    for _, index in ipairs({0, 3, -1, 1e9, 10^300, 0.9, math.mininteger}) do
      refused("this robot has 2 LEDs, counted from 1", one, index, "red")
    end
    refused("number expected, got string", one, "1", "red")
    refused("finite number expected", one, 0/0, "red")
    refused("is no color", one, 1, "reddish")
    refused("is no color", one, 1, "1,2,3")
    refused("is no color", one, 1, "1,2,3,256")
    refused("is no color", one, 1, "1,2,3,4,5")
    refused("is no color", one, 1, "")
    refused("string expected, got nil", one, 1, nil)
    refused("string expected, got number", one, 1, 5)
    refused("finite number expected", one, 1, 0, 0/0, 0)
    refused("number expected, got string", one, 1, 0, "0", 0)
    refused("got 1$", one, 1)
    refused("got 3$", one, 1, 2, 3)
    refused("got 5$", one, 1, 2, 3, 4, 5)
    refused("got 0$", all)
    refused("got 2$", all, 1, 2)
    refused("got 4$", all, 1, 2, 3, 4)
  )lua"));
  EXPECT_EQ(command().led_colors_size(), 0);
}

TEST(Colors, AreThoseOfTheSceneFormat) {
  EXPECT_EQ(parse_color("orange"), (Color{255, 140, 0}));
  EXPECT_EQ(parse_color("gray90"), (Color{229, 229, 229}));
  EXPECT_EQ(parse_color("0,0,0,0"), (Color{}));
  for (const char* wrong :
       {"Red", "gray45", "1,2,3,", ",,,", "1,2,3,-4", "1.5,2,3,4", "0x1,2,3,4"}) {
    EXPECT_FALSE(parse_color(wrong)) << wrong;
  }
}

// ---- tags and magnets ---------------------------------------------------------------------------

TEST_F(Devices, TagPayloads) {
  for (int i = 0; i < 3; ++i) robot_.add_tags();
  EXPECT_RUNS(start(R"lua(
    local one, all = robot.tags.set_single_payload, robot.tags.set_all_payloads
    all("x")
    one(2, "zero \0 inside")
    refused("this robot has 3 tags", one, 4, "x")
    refused("string expected, got number", one, 1, 5)
    refused("string expected, got nil", all, nil)
    refused("65537 bytes; at most 65536 are allowed", all, ("x"):rep(65537))
    refused("got 1$", one, 1)
    refused("got 0$", all)
  )lua"));
  const v1::Command sent = command();
  ASSERT_EQ(sent.tag_payloads_size(), 3);
  EXPECT_EQ(sent.tag_payloads(0), "x");
  EXPECT_EQ(sent.tag_payloads(1), std::string("zero \0 inside", 13));
}

TEST_F(Devices, MagnetCurrents) {
  robot_.add_magnets()->set_id("magnet_0");
  robot_.add_magnets()->set_id("grip per");
  EXPECT_RUNS(start(R"lua(
    robot.magnets["grip per"].set_current(-2)
    local set = robot.magnets.magnet_0.set_current
    refused("finite number expected", set, 0/0)
    refused("finite number expected", set, -math.huge)
    refused("number expected, got string", set, "1")
    refused("set_current%(current%) expected, got 0", set)
  )lua"));
  const v1::Command sent = command();
  ASSERT_EQ(sent.magnet_currents_size(), 2);
  EXPECT_EQ(sent.magnet_currents(0), 0);
  EXPECT_EQ(sent.magnet_currents(1), -2);
}

// ---- sensors ------------------------------------------------------------------------------------

TEST_F(Devices, ProximityIsAnArray) {
  for (int i = 0; i < 3; ++i) robot_.add_proximity_sensors();
  EXPECT_RUNS(start(R"lua(
    kept = robot.proximity
    assert(#kept == 3 and kept[1] == 0 and kept[3] == 0)
    function step() assert(kept[1] == 0.25 and robot.proximity[3] == 1 and #kept == 3) end
  )lua"));
  assign(*seen().mutable_proximity(), {0.25, 0, 1});
  EXPECT_RUNS(step());
}

TEST_F(Devices, ProximityWithAnglesIsAnArrayOfTables) {
  for (const double angle : {0.5, 1.5, -3.0}) robot_.add_proximity_sensors()->set_angle(angle);
  EXPECT_RUNS(start(R"lua(
    local all = robot.proximity
    local second, third = all[2], all[3]
    assert(#all == 3 and second.value == 0 and second.angle == 1.5 and third.angle == -3)
    all[1] = nil
    function step()
      assert(second.value == 0.25 and second.angle == 1.5 and third.value == 1)
      assert(robot.proximity == all and all[2] == second and all[1] == nil)
    end
  )lua"));
  assign(*seen().mutable_proximity(), {0.75, 0.25, 1});
  EXPECT_RUNS(step());
}

TEST_F(Devices, PositioningIsPositionAngleAndAxis) {
  robot_.set_positioning(true);
  EXPECT_RUNS(start(R"lua(
    position, orientation = robot.positioning.position, robot.positioning.orientation
    assert(position.x == 0 and position.y == 0 and position.z == 0)
    assert(orientation.angle == 0 and orientation.axis.z == 1 and orientation.axis.x == 0)
    function step()
      assert(position.x == 1 and position.y == -2 and position.z == 3)
      assert(math.abs(orientation.angle - math.pi / 2) < 1e-12, "the other way round it is less than pi")
      assert(math.abs(orientation.axis.x - 1) < 1e-12 and orientation.axis.z == 0)
      assert(orientation.yaw == 0)
    end
  )lua"));
  const double half = 3 * std::acos(-1.0) / 4;
  assign(*seen().mutable_positioning(), {1, -2, 3, std::cos(half), -std::sin(half), 0, 0});
  EXPECT_RUNS(step());
}

/// Orientation of a robot that turns on the spot, as a quaternion that is integrated without end.
TEST_F(Devices, PositioningHasOneFormOfEachRotation) {
  robot_.set_positioning(true);
  EXPECT_RUNS(start(R"lua(
    turned = 0
    function step()
      turned = turned + 0.1
      local o = robot.positioning.orientation
      local yaw = math.atan(math.sin(turned), math.cos(turned))
      assert(o.angle >= 0 and o.angle <= math.pi, o.angle)
      assert(math.abs(o.yaw - yaw) < 1e-9, o.yaw)
      assert(math.abs(o.angle * o.axis.z - yaw) < 1e-9, o.angle)
    end
  )lua"));
  for (int i = 1; i <= 200; ++i) {  // three turns
    seen().clear_positioning();
    assign(*seen().mutable_positioning(), {0, 0, 0, std::cos(0.05 * i), 0, 0, std::sin(0.05 * i)});
    EXPECT_RUNS(step());
  }
}

TEST_F(Devices, ImusRead) {
  robot_.add_imus()->set_id("front");
  robot_.add_imus()->set_id("rear");
  EXPECT_RUNS(start(R"lua(
    acceleration, turning = robot.imus.front.acceleration, robot.imus.rear.angular_velocity
    assert(acceleration.x == 0 and turning.z == 0)
    function step()
      assert(acceleration.x == 1 and acceleration.y == 2 and acceleration.z == 3)
      assert(robot.imus.rear.acceleration.z == 9)
      assert(turning.x == 10 and turning.y == 11 and turning.z == 12)
      robot.imus = nil
    end
  )lua"));
  assign(*seen().mutable_imus(), {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});
  EXPECT_RUNS(step());
}

TEST_F(Devices, ContactSensorsRead) {
  robot_.add_contact_sensors()->set_id("left");
  robot_.add_contact_sensors()->set_id("right");
  EXPECT_RUNS(start(R"lua(
    right = robot.contact_sensors.right
    force = right.force
    assert(right.touches == false and right.strength == 0 and force.z == 0)
    function step()
      assert(not robot.contact_sensors.left.touches)
      assert(right.touches == true and right.strength == 9)
      assert(force.x == 2 and force.y == 3 and force.z == 4)
    end
  )lua"));
  assign(*seen().mutable_contact_sensors(), {0, 0, 0, 0, 0, 1, 2, 3, 4, 9});
  EXPECT_RUNS(step());
}

TEST_F(Devices, BatteryReads) {
  robot_.set_battery(true);
  EXPECT_RUNS(start(R"lua(
    battery = robot.battery
    assert(battery.available_charge == 0 and battery.time_left == 0)
    function step() assert(battery.available_charge == 0.5 and battery.time_left == math.huge) end
  )lua"));
  assign(*seen().mutable_batteries(), {0.5, std::numeric_limits<double>::infinity()});
  EXPECT_RUNS(step());
}

// ---- range and bearing --------------------------------------------------------------------------

TEST_F(Devices, RangeAndBearingPacketsAreInCentimetres) {
  robot_.mutable_range_and_bearing()->set_receives(true);
  EXPECT_RUNS(start(R"lua(
    heard = robot.range_and_bearing
    assert(#heard == 0)
    function step()
      assert(#heard == 2 and heard[1].range == 150 and heard[2].range == 0)
      assert(heard[1].horizontal_bearing == -0.5 and heard[1].vertical_bearing == 0.25)
      assert(#heard[1].data == 2 and heard[1].data[2] == 255)
      assert(math.type(heard[1].data[1]) == "integer")
      function step() assert(#heard == 0) end
    end
  )lua"));
  v1::RangeAndBearingPacket& far = *seen().add_range_and_bearing();
  far.set_range(1.5);
  far.set_horizontal_bearing(-0.5);
  far.set_vertical_bearing(0.25);
  far.set_data("\1\xff");
  seen().add_range_and_bearing()->set_data("\1\xff");
  EXPECT_RUNS(step());
  seen().clear_range_and_bearing();
  EXPECT_RUNS(step());
}

TEST_F(Devices, RangeAndBearingData) {
  robot_.mutable_range_and_bearing()->set_sends(true);
  robot_.mutable_range_and_bearing()->set_data_size(3);
  EXPECT_RUNS(start(R"lua(
    local device = robot.range_and_bearing
    device.set_data({1, 2, 3})
    device.set_data(2, 258.5)
    refused("2 numbers; this robot sends packets of 3 bytes", device.set_data, {1, 2})
    refused("4 numbers", device.set_data, {1, 2, 3, 4})
    refused("element 3 of the table, got string", device.set_data, {7, 7, "7"})
    refused("counted from 1", device.set_data, 4, 1)
    refused("counted from 1", device.set_data, 0, 1)
    refused("finite number expected", device.set_data, 1, 0/0)
    refused("table expected, got number", device.set_data, 1)
    refused("got 3$", device.set_data, 1, 2, 3)
    refused("clear_data%(%) expected, got 1", device.clear_data, 1)
    function step() robot.range_and_bearing.clear_data() end
  )lua"));
  EXPECT_EQ(command().range_and_bearing_data(), "\1\2\3");
  EXPECT_RUNS(step());
  EXPECT_EQ(command().range_and_bearing_data(), std::string(3, '\0'));
}

// ---- memory -------------------------------------------------------------------------------------

TEST_F(Devices, TablesAreMadeOnce) {
  add_radio(robot_, "r", {.receives = true, .sends = true});
  for (int i = 0; i < 4; ++i) robot_.add_leds();
  for (int i = 0; i < 24; ++i) robot_.add_proximity_sensors();
  robot_.set_positioning(true);
  robot_.set_battery(true);
  add_driving(robot_);
  robot_.add_cameras()->set_detects_tags(true);
  EXPECT_RUNS(start(R"lua(
    collectgarbage("stop")
    function step()
      local used = collectgarbage("count")
      assert(before == nil or used == before, "a tick takes memory")
      robot.leds.set_all_colors(1, 2, 3)
      before = collectgarbage("count")
    end
  )lua"));
  for (int i = 0; i < 20; ++i) EXPECT_RUNS(step());
}

}  // namespace
}  // namespace ziggurat::lua
