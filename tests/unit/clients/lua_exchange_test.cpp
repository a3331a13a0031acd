// Every device from a session to a script and back, against a server that the test scripts.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "equipped_robots.h"
#include "fake_server.h"
#include "program/runner.h"

namespace ziggurat::lua {
namespace {

/// Runs one script for all robots of a session.
class Exchange : public ::testing::Test {
 protected:
  Exchange() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::path(::testing::TempDir()) /
            (std::string("exchange_") + test->name() + ".lua");
  }
  ~Exchange() override { std::filesystem::remove(path_); }

  bool runs(const FakeServer& server, const std::string& script) {
    std::ofstream(path_) << script;
    ziggurat::Session session(options_for(server));
    ProgramOptions options;
    options.script = path_;
    options.quiet = true;
    Runner runner(session, options);
    runner.run();
    return !runner.has_failures();
  }

 private:
  std::filesystem::path path_;
};

TEST_F(Exchange, ReadingsReachTheScript) {
  FakeServer server([](FakeServer& self) {
    self.welcome(welcome());
    self.send(observation(0));
    self.receive();
    auto message = observation(1);
    receive(message, 2, std::string("\0\xff", 2));
    receive(message, 2, "");
    v1::RangeAndBearingPacket& packet = *message.mutable_observation()->add_range_and_bearing();
    packet.set_robot(2);
    packet.set_range(0.5);
    packet.set_data("xy");
    v1::Observation& seen = *message.mutable_observation();
    seen.set_led_counts(1, 1);
    add_led(seen, 0xFF8001, 1, 2);
    seen.set_directional_led_counts(0, 1);
    add_directional_led(seen, 0x0000FF, 3, 4);
    seen.set_tag_counts(3, 1);
    add_tag(seen, "42", 5, 6, 10);
    seen.set_camera_images(1, "123456");
    self.send(message);
    const auto answer = self.receive();
    EXPECT_TRUE(answer.has_command()) << answer.ShortDebugString();
    self.end();
    self.receive();
  });
  EXPECT_TRUE(runs(server, R"lua(
    function init()
      if robot.id == "a" then
        assert(not (robot.radios or robot.proximity or robot.positioning or robot.battery))
        assert(not (robot.cameras or robot.wheels or robot.turret))
      else
        assert(#robot.radios.ears.rx_data == 0 and robot.radios.mouth.rx_data == nil)
      end
    end
    function step()
      if robot.id == "b" then
        assert(robot.cameras.eye.directional_led_detector[1].color.blue == 255)
        assert(#robot.cameras.eye.led_detector == 0 and robot.cameras.eye.image == "")
        assert(robot.proximity[1] == 0.25, "a sensor that does not tell its angle")
      end
      if robot.id ~= "c" then return end
      local heard = robot.radios.ears.rx_data
      assert(#heard == 2 and heard[1][1] == 0 and heard[1][2] == 255 and #heard[2] == 0)
      assert(robot.proximity[1].value == 0.75 and robot.proximity[1].angle == -0.5)
      assert(#robot.proximity == 1)
      assert(robot.positioning.position.x == 7 and robot.positioning.position.z == 9)
      assert(robot.battery.available_charge == 0.5 and robot.battery.time_left == 50)
      local packet = robot.range_and_bearing[1]
      assert(packet.range == 50 and packet.data[2] == 121 and #robot.range_and_bearing == 1)
      local eye, lens = robot.cameras.eye, robot.cameras.lens
      assert(#eye.led_detector == 1 and eye.led_detector[1].color.green == 128)
      assert(eye.led_detector[1].center.y == 2 and #eye.tag_detector == 0)
      assert(lens.tag_detector[1].payload == "42" and lens.tag_detector[1].corners[4].y == 17)
      assert(eye.image == "123456" and lens.image == nil and lens.led_detector == nil)
      assert(eye.anchor == "turret" and eye.resolution.x == 2 and eye.focal_length.y == 900)
      assert(math.abs(robot.wheels.velocity_left - 4) < 1e-12)
      assert(math.abs(robot.wheels.distance_right - 7) < 1e-12)
      assert(math.abs(robot.wheels.axis_length - 14) < 1e-12 and robot.turret.rotation == -3)
    end
  )lua"));
}

TEST_F(Exchange, CommandsReachTheServer) {
  FakeServer server([](FakeServer& self) {
    self.welcome(welcome());
    self.send(observation(0));
    const auto command = self.receive().command();
    EXPECT_EQ(command.led_colors_size(), 4);
    EXPECT_EQ(command.led_colors(3), 0xFF0000U);
    EXPECT_EQ(command.led_colors(1), 0x010203U) << "the scene's color";
    EXPECT_EQ(command.directional_led_colors(1), 0x010203U);
    EXPECT_EQ(command.tag_payloads(0), "start");
    EXPECT_EQ(command.tag_payloads(1), "new");
    EXPECT_EQ(command.magnet_currents(1), -1);
    EXPECT_EQ(command.range_and_bearing_data(), std::string("\0\0\0\7", 4));
    ASSERT_EQ(command.radio_messages_size(), 2);
    EXPECT_EQ(command.radio_messages(0).radio(), 3U);
    EXPECT_EQ(command.radio_messages(0).payload(), "\xff\x02");
    EXPECT_EQ(command.radio_messages(1).payload(), "");
    ASSERT_EQ(command.wheel_velocities_size(), 4);
    EXPECT_EQ(command.wheel_velocities(2), 0.05);
    EXPECT_EQ(command.wheel_velocities(3), -0.1);
    ASSERT_EQ(command.turret_modes_size(), 2);
    EXPECT_EQ(command.turret_modes(0), v1::TURRET_PASSIVE);
    EXPECT_EQ(command.turret_modes(1), v1::TURRET_POSITION);
    EXPECT_EQ(command.turret_rotations(1), 1.5);
    EXPECT_NEAR(command.turret_speeds(1), 0.2094395, 1e-6);
    self.send(observation(1));
    const auto second = self.receive().command();
    EXPECT_EQ(second.radio_messages_size() + second.led_colors_size() +
                  second.wheel_velocities_size() + second.turret_modes_size(),
              0);
    self.end();
    self.receive();
  });
  EXPECT_TRUE(runs(server, R"lua(
    function init()
      if robot.id ~= "c" then return end
      robot.leds.set_single_color(2, "red")
      robot.directional_leds.set_all_colors(1, 2, 3)
      robot.tags.set_all_payloads("new")
      robot.magnets.magnet_0.set_current(-1)
      robot.range_and_bearing.set_data(2, 7)
      robot.radios.mouth.tx_data({-1, 258})
      robot.radios.mouth.tx_data({})
      robot.wheels.set_velocity(5, -10)
      robot.turret.set_position_control_mode()
      robot.turret.set_rotation(1.5)
      robot.turret.set_rotation_speed(2.9)
    end
    function step() end
  )lua"));
}

TEST_F(Exchange, ARobotThatSendsTooMuchForTheSessionFails) {
  FakeServer server([](FakeServer& self) {
    self.welcome(welcome());  // a session may send 4 MiB at a tick
    self.send(observation(0));
    const auto leave = self.receive().leave();
    ASSERT_EQ(leave.robots_size(), 1);
    EXPECT_EQ(leave.robots(0), 2U);
    EXPECT_EQ(leave.reason(), v1::Leave::FAILED);
    EXPECT_NE(leave.message().find("bytes by radio at this tick"), std::string::npos);
    EXPECT_GE(self.receive().command().radio_messages_size(), 3);
    self.end();
    self.receive();
  });
  EXPECT_FALSE(runs(server, R"lua(
    function init()
      if robot.id ~= "c" then return end
      local long = {}
      for i = 1, 1 << 20 do long[i] = 0 end
      for i = 1, 5 do robot.radios.mouth.tx_data(long) end
    end
    function step() end
  )lua"));
}

}  // namespace
}  // namespace ziggurat::lua
