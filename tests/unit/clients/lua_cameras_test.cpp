// SPDX-License-Identifier: MIT
// robot.cameras, robot.wheels and robot.turret as scripts find them.

#include <numbers>

#include "equipped_robots.h"
#include "lua_devices.h"

namespace ziggurat::lua {
namespace {

v1::CameraDescription& add_camera(v1::RobotDescription& robot, const char* id) {
  v1::CameraDescription& camera = *robot.add_cameras();
  camera.set_id(id);
  camera.set_anchor("turret");
  for (const double value : {0.1, 0.2, 0.3}) camera.add_position(value);
  for (const double value : {0.5, -0.5, 0.5, -0.5}) camera.add_orientation(value);
  camera.set_near(0.125);
  camera.set_far(2);
  for (const double value : {800.0, 900.0}) camera.add_focal_length(value);
  for (const double value : {320.0, 240.5}) camera.add_principal_point(value);
  camera.set_width(640);
  camera.set_height(480);
  camera.set_detects_leds(true);
  camera.set_detects_directional_leds(true);
  camera.set_detects_tags(true);
  return camera;
}

// ---- cameras ------------------------------------------------------------------------------------

TEST_F(Devices, CamerasHaveTheDetectorsThatTheSceneGives) {
  add_camera(robot_, "eye");
  robot_.add_cameras()->set_id("blind eye");
  EXPECT_RUNS(start(R"lua(
    local function keys(of)
      local names = {}
      for name in pairs(of) do names[#names + 1] = name end
      return table.concat(names, " ")
    end
    local common = "anchor %sfar focal_length %snear orientation position principal_point resolution"
    assert(keys(robot.cameras["blind eye"]) == common:format("", ""))
    assert(keys(robot.cameras.eye) ==
           common:format("directional_led_detector ", "led_detector ") .. " tag_detector")
    for _, detector in ipairs{"led_detector", "directional_led_detector", "tag_detector"} do
      local readings = robot.cameras.eye[detector]
      assert(type(readings) == "table" and next(readings) == nil, detector)
    end
    assert(keys(robot.cameras) == "blind eye eye")
  )lua"));
}

TEST_F(Devices, CamerasHavePoseAndIntrinsics) {
  add_camera(robot_, "eye");
  EXPECT_RUNS(start(R"lua(
    local eye = robot.cameras.eye
    assert(eye.anchor == "turret" and eye.near == 0.125 and eye.far == 2)
    assert(eye.position.x == 0.1 and eye.position.y == 0.2 and eye.position.z == 0.3)
    assert(math.abs(eye.orientation.angle - 2 * math.pi / 3) < 1e-12)
    local axis = eye.orientation.axis
    assert(math.abs(axis.x + 3^-0.5) < 1e-12 and math.abs(axis.y - 3^-0.5) < 1e-12)
    assert(eye.focal_length.x == 800 and eye.focal_length.y == 900)
    assert(eye.principal_point.x == 320 and eye.principal_point.y == 240.5)
    assert(eye.resolution.x .. "x" .. eye.resolution.y == "640x480", "integers")
  )lua"));
}

TEST_F(Devices, CameraReadingsAreReplacedAndMayBeKept) {
  add_camera(robot_, "eye");
  add_camera(robot_, "lens");
  EXPECT_RUNS(start(R"lua(
    eye, lens = robot.cameras.eye, robot.cameras.lens
    tags, leds = eye.tag_detector, eye.led_detector
    function step()
      assert(tags == robot.cameras.eye.tag_detector and leds == eye.led_detector, "same arrays")
      expect()
    end
    function expect()
      assert(#leds == 1 and #tags == 2 and #eye.directional_led_detector == 1)
      assert(#lens.tag_detector == 0 and #lens.led_detector == 0)
      local led = leds[1]
      assert(led.color.red == 255 and led.color.green == 128 and led.color.blue == 1)
      assert(math.type(led.color.red) == "integer")
      assert(led.center.x == 10.5 and led.center.y == 20)
      assert(eye.directional_led_detector[1].center.y == -4)
      local tag = tags[1]
      assert(tag.payload == "a\0b" and tag.center.x == 1 and tag.center.y == 2)
      assert(#tag.corners == 4 and tag.corners[1].x == 3 and tag.corners[4].y == 10)
      assert(tags[2].payload == "")
      kept = tag
      function expect()
        assert(#leds == 0 and #tags == 1 and tags[2] == nil)
        assert(tags[1].payload == "next" and tags[1].corners[2].x == 0)
        assert(kept.payload == "a\0b" and kept.corners[4].y == 10, "may be kept")
        robot.cameras = nil
        function expect() end
      end
    end
  )lua"));
  const v1::Observation nothing = seen();
  seen().set_led_counts(0, 1);
  add_led(seen(), 0xFF8001, 10.5, 20);
  seen().set_directional_led_counts(0, 1);
  add_directional_led(seen(), 0x00FF00, 3, -4);
  seen().set_tag_counts(0, 2);
  add_tag(seen(), std::string("a\0b", 3), 1, 2, 3);
  add_tag(seen(), "", 0, 0, 0);
  EXPECT_RUNS(step());
  seen() = nothing;
  seen().set_tag_counts(0, 1);
  add_tag(seen(), "next", 0, 0, -2);
  EXPECT_RUNS(step());
}

TEST_F(Devices, CameraReadingsDoNotDependOnTheTableRobot) {
  add_camera(robot_, "eye");
  EXPECT_RUNS(start(R"lua(
    tags = robot.cameras.eye.tag_detector
    robot.cameras.eye.tag_detector = nil
    robot.cameras = "gone"
    tags[7] = "mine"
    function step() assert(#tags == 1 and tags[1].payload == "x") end
  )lua"));
  seen().set_tag_counts(0, 1);
  add_tag(seen(), "x", 0, 0, 0);
  EXPECT_RUNS(step());
}

TEST_F(Devices, CameraImagesAreStrings) {
  v1::CameraDescription& eye = add_camera(robot_, "eye");
  eye.set_image(true);
  eye.set_width(2);
  eye.set_height(1);
  add_camera(robot_, "lens");
  EXPECT_RUNS(start(R"lua(
    eye = robot.cameras.eye
    assert(eye.image == "" and robot.cameras.lens.image == nil)
    function step()
      assert(#eye.image == 6 and eye.image:byte(1) == 0 and eye.image:byte(6) == 255)
      assert(robot.cameras.lens.image == nil)
    end
  )lua"));
  seen().set_camera_images(0, std::string("\0\1\2\3\4\xff", 6));
  EXPECT_RUNS(step());
}

// ---- wheels -------------------------------------------------------------------------------------

TEST_F(Devices, WheelsAreInCentimetres) {
  add_driving(robot_);
  EXPECT_RUNS(start(R"lua(
    wheels = robot.wheels
    assert(wheels.velocity_left == 0 and wheels.velocity_right == 0)
    assert(wheels.distance_left == 0 and wheels.distance_right == 0)
    assert(math.abs(wheels.axis_length - 14) < 1e-12)
    wheels.set_velocity(5, -2.5)
    function step()
      assert(wheels == robot.wheels)
      assert(wheels.velocity_left == 25 and wheels.velocity_right == -50)
      assert(wheels.distance_left == 2.5 and wheels.distance_right == -5)
    end
  )lua"));
  const v1::Command sent = command();
  ASSERT_EQ(sent.wheel_velocities_size(), 2);
  EXPECT_EQ(sent.wheel_velocities(0), 0.05);
  EXPECT_EQ(sent.wheel_velocities(1), -0.025);
  int i = 0;
  for (const double value : {0.25, -0.5, 0.025, -0.05}) seen().set_wheels(i++, value);
  EXPECT_RUNS(step());
}

TEST_F(Devices, WheelsRefuseInvalidSpeeds) {
  add_driving(robot_);
  EXPECT_RUNS(start(R"lua(
    local set = robot.wheels.set_velocity
    refused("set_velocity%(left, right%) expected, got 1", set, 1)
    refused("got 3$", set, 1, 2, 3)
    refused("finite number expected", set, 1, 0/0)
    refused("finite number expected", set, math.huge, 1)
    refused("number expected, got string", set, "1", 1)
    refused("number expected, got nil", set, 1, nil)
  )lua"));
  EXPECT_EQ(command().wheel_velocities_size(), 0);
}

TEST_F(Devices, WheelsAndTurretHaveTheEnabledParts) {
  add_driving(robot_);
  robot_.mutable_wheels()->set_measures(false);
  robot_.mutable_turret()->set_drives(false);
  EXPECT_RUNS(start(R"lua(
    assert(robot.wheels.set_velocity and not robot.wheels.velocity_left)
    assert(robot.wheels.axis_length > 0)
    assert(robot.turret.rotation == 0 and not robot.turret.set_rotation)
    assert(not robot.turret.set_passive_mode)
    function step() assert(robot.wheels.velocity_left == nil and robot.turret.rotation == -2) end
  )lua"));
  seen().set_turret_rotations(0, -2);
  EXPECT_RUNS(step());
}

// ---- turret -------------------------------------------------------------------------------------

TEST_F(Devices, TurretSpeedsAreWholeTurnsPerMinute) {
  add_driving(robot_);
  EXPECT_RUNS(start(R"lua(
    local turret = robot.turret
    turret.set_speed_control_mode()
    turret.set_rotation_speed(2.9)
    function step()
      if not backward then
        turret.set_rotation_speed(-2.9)
        backward = true
        return
      end
      turret.set_rotation_speed(0.99)
    end
  )lua"));
  const v1::Command sent = command();
  ASSERT_EQ(sent.turret_modes_size(), 1);
  EXPECT_EQ(sent.turret_modes(0), v1::TURRET_SPEED);
  EXPECT_EQ(sent.turret_rotations_size(), 0);
  EXPECT_DOUBLE_EQ(sent.turret_speeds(0), 2 * std::numbers::pi / 30);
  EXPECT_RUNS(step());
  EXPECT_DOUBLE_EQ(command().turret_speeds(0), -2 * std::numbers::pi / 30);
  EXPECT_RUNS(step());
  EXPECT_EQ(command().turret_speeds(0), 0);
}

TEST_F(Devices, TurretModesAndRotation) {
  add_driving(robot_);
  EXPECT_RUNS(start(R"lua(
    turret = robot.turret
    assert(turret.rotation == 0)
    turret.set_position_control_mode()
    turret.set_rotation(-1.5)
    function step()
      assert(turret.rotation == 0.75)
      turret.set_passive_mode()
    end
  )lua"));
  const v1::Command sent = command();
  EXPECT_EQ(sent.turret_modes(0), v1::TURRET_POSITION);
  EXPECT_EQ(sent.turret_rotations(0), -1.5);
  seen().set_turret_rotations(0, 0.75);
  EXPECT_RUNS(step());
  EXPECT_EQ(command().turret_modes(0), v1::TURRET_PASSIVE);
}

TEST_F(Devices, TurretRefusesWrongArguments) {
  add_driving(robot_);
  EXPECT_RUNS(start(R"lua(
    local turret = robot.turret
    refused("set_rotation%(angle%) expected, got 0", turret.set_rotation)
    refused("finite number expected", turret.set_rotation, 0/0)
    refused("number expected, got string", turret.set_rotation, "1")
    refused("set_rotation_speed%(turns_per_minute%) expected, got 2",
            turret.set_rotation_speed, 1, 2)
    refused("finite number expected", turret.set_rotation_speed, math.huge)
    refused("set_passive_mode%(%) expected, got 1", turret.set_passive_mode, turret)
    refused("set_speed_control_mode%(%) expected, got 1", turret.set_speed_control_mode, 1)
    refused("set_position_control_mode%(%) expected, got 1", turret.set_position_control_mode, 1)
  )lua"));
  const v1::Command sent = command();
  EXPECT_EQ(sent.turret_modes_size() + sent.turret_rotations_size() + sent.turret_speeds_size(), 0);
}

}  // namespace
}  // namespace ziggurat::lua
