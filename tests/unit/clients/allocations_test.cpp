// SPDX-License-Identifier: MIT
// The client's tick path keeps its memory.

#include "allocations/allocations.h"

#include <gtest/gtest.h>

#include <string>

#include "equipped_robots.h"
#include "fake_server.h"
#include "ziggurat/v1/protocol.pb.h"
#include "ziggurat/ziggurat.h"

namespace ziggurat {
namespace {

constexpr std::uint64_t ticks = 50;

/// Both robots' eyes see three LEDs and take pictures; their lenses see five tags each.
v1::ServerMessage sight(std::uint64_t tick) {
  v1::ServerMessage message = observation(tick);
  v1::Observation& seen = *message.mutable_observation();
  for (int robot = 0; robot < 2; ++robot) {
    seen.set_led_counts(robot, 3);
    for (int i = 0; i < 3; ++i) add_led(seen, 0xFF8001, i, robot);
    seen.set_tag_counts(2 * robot + 1, 5);
    for (int i = 0; i < 5; ++i) add_tag(seen, std::string(40, 'x'), i, robot, 0);
    seen.set_camera_images(robot, "123456");
  }
  return message;
}

TEST(TickPath, SensingAndDrivingAllocateNothing) {
  FakeServer server([](FakeServer& self) {
    self.welcome(welcome());
    for (std::uint64_t tick = 0; tick < ticks; ++tick) {
      self.send(sight(tick));
      EXPECT_EQ(self.receive().command().wheel_velocities_size(), 4);
    }
    self.finish();
  });
  Session session(options_for(server));
  std::size_t before = 0;
  std::size_t tags = 0;
  while (session.next()) {
    for (Robot& robot : session.robots()) {
      for (const Camera& camera : robot.cameras()) tags += camera.tags().size();
      if (Wheels* wheels = robot.wheels()) wheels->set_velocity(1, 2);
      if (Turret* turret = robot.turret()) {
        turret->set_mode(TurretMode::speed);
        turret->set_rotation_speed(1);
      }
    }
    if (session.tick() == ticks / 2) before = testing::allocations();
    if (session.tick() > ticks / 2) {
      EXPECT_EQ(testing::allocations(), before) << session.tick();
    }
  }
  EXPECT_EQ(tags, 10 * ticks);
  EXPECT_GT(before, 0U) << "they are not counted";
}

}  // namespace
}  // namespace ziggurat
