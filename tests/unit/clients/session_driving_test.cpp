// SPDX-License-Identifier: MIT
// Wheels and turrets of the client, against a server that the test scripts.

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "equipped_robots.h"
#include "fake_server.h"
#include "ziggurat/v1/protocol.pb.h"
#include "ziggurat/ziggurat.h"

namespace ziggurat {
namespace {

std::vector<double> list(const google::protobuf::RepeatedField<double>& values) {
  return {values.begin(), values.end()};
}

TEST(Driving, IsDescribedAndRead) {
  FakeServer server([](FakeServer& self) {
    self.welcome(welcome());
    self.send(observation(0));
    self.receive();
  });
  Session session(options_for(server));
  EXPECT_EQ(session.robot("a").wheels(), nullptr);
  EXPECT_EQ(session.robot("a").turret(), nullptr);
  ASSERT_TRUE(session.next());
  const Wheels& wheels = *session.robot("c").wheels();
  EXPECT_EQ(wheels.axle_length(), 0.14);
  EXPECT_TRUE(wheels.drives() && wheels.measures());
  EXPECT_EQ(wheels.reading().velocity_left, 0.04);
  EXPECT_EQ(wheels.reading().velocity_right, 0.05);
  EXPECT_EQ(wheels.reading().distance_left, 0.06);
  EXPECT_EQ(wheels.reading().distance_right, 0.07);
  EXPECT_EQ(session.robot("b").turret()->rotation(), 0.5);
  EXPECT_EQ(session.robot("c").turret()->rotation(), -3);
}

TEST(Driving, ValuesAreSentOnce) {
  FakeServer server([](FakeServer& self) {
    self.welcome(welcome());
    self.send(observation(0));
    const auto first = self.receive().command();
    EXPECT_EQ(list(first.wheel_velocities()), (std::vector<double>{0, 0, 0.25, -0.5}));
    ASSERT_EQ(first.turret_modes_size(), 2);
    EXPECT_EQ(first.turret_modes(0), v1::TURRET_SPEED);
    EXPECT_EQ(first.turret_modes(1), v1::TURRET_PASSIVE);
    EXPECT_EQ(list(first.turret_speeds()), (std::vector<double>{-2, 0}));
    EXPECT_EQ(first.turret_rotations_size(), 0) << "nothing new";
    self.send(observation(1));
    const auto second = self.receive().command();
    EXPECT_EQ(second.wheel_velocities_size() + second.turret_modes_size() +
                  second.turret_speeds_size() + second.turret_rotations_size(),
              0);
    self.send(observation(2));
    const auto third = self.receive().command();
    EXPECT_EQ(list(third.wheel_velocities()), (std::vector<double>{1, 1, 0.25, -0.5}));
    EXPECT_EQ(third.turret_modes(1), v1::TURRET_POSITION);
    EXPECT_EQ(list(third.turret_rotations()), (std::vector<double>{0, 1.5}));
    self.finish();
  });
  Session session(options_for(server));
  Robot& b = session.robot("b");
  Robot& c = session.robot("c");
  ASSERT_TRUE(session.next());
  c.wheels()->set_velocity(0.25, -0.5);
  b.turret()->set_mode(TurretMode::speed);
  b.turret()->set_rotation_speed(-2);
  ASSERT_TRUE(session.next());
  ASSERT_TRUE(session.next());
  b.wheels()->set_velocity(1, 1);
  c.turret()->set_mode(TurretMode::position);
  c.turret()->set_rotation(1.5);
  EXPECT_FALSE(session.next());
}

TEST(Driving, AResetStopsIt) {
  FakeServer server([](FakeServer& self) {
    self.welcome(welcome());
    self.send(observation(0));
    self.receive();
    self.reset();
    self.send(observation(0));
    const auto command = self.receive().command();
    EXPECT_EQ(list(command.wheel_velocities()), (std::vector<double>{1, 2, 0, 0}));
    EXPECT_EQ(command.turret_modes_size() + command.turret_speeds_size(), 0);
    self.finish();
  });
  Session session(options_for(server));
  ASSERT_TRUE(session.next());
  session.robot("c").wheels()->set_velocity(9, 9);
  session.robot("c").turret()->set_mode(TurretMode::speed);
  session.robot("c").turret()->set_rotation_speed(9);
  ASSERT_TRUE(session.next());
  session.robot("b").wheels()->set_velocity(1, 2);
  EXPECT_FALSE(session.next());
}

TEST(Driving, RefusesInvalidValues) {
  FakeServer server([](FakeServer& self) {
    auto message = welcome();
    message.mutable_welcome()->mutable_robots(1)->mutable_wheels()->set_drives(false);
    message.mutable_welcome()->mutable_robots(1)->mutable_turret()->set_drives(false);
    self.welcome(message);
    self.receive();
  });
  Session session(options_for(server));
  Robot& b = session.robot("b");
  EXPECT_FALSE(b.wheels()->drives() || b.turret()->drives());
  EXPECT_THROW(b.wheels()->set_velocity(1, 1), std::logic_error);
  EXPECT_THROW(b.turret()->set_mode(TurretMode::speed), std::logic_error);
  EXPECT_THROW(b.turret()->set_rotation(1), std::logic_error);
  EXPECT_THROW(b.turret()->set_rotation_speed(1), std::logic_error);
  Robot& c = session.robot("c");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(c.wheels()->set_velocity(1, nan), std::invalid_argument);
  EXPECT_THROW(c.wheels()->set_velocity(-1 / 0.0, 1), std::invalid_argument);
  EXPECT_THROW(c.turret()->set_rotation(nan), std::invalid_argument);
  EXPECT_THROW(c.turret()->set_rotation_speed(nan), std::invalid_argument);
}

TEST(Driving, UnannouncedValuesAreRefused) {
  const auto refused = [](const v1::ServerMessage& message, const char* words) {
    expect_refused(welcome(), message, words);
  };
  auto message = observation(0);
  message.mutable_observation()->add_wheels(1);
  refused(message, "9 numbers of wheels; it had announced 8");
  message = observation(0);
  message.mutable_observation()->clear_turret_rotations();
  refused(message, "0 rotations of turrets");
}

}  // namespace
}  // namespace ziggurat
