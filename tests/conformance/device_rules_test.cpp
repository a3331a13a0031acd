// The rules D1 … of docs/protocol.md. A test is named after the rule it holds.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "network/peers.h"
#include "world/limits.h"

namespace ziggurat::network {
namespace {

/// Three robots with a radio each; that of robot2 only receives. "p" holds robot0 and robot2 and
/// owes tick 5, "q" holds robot1.
struct Radios : ::testing::Test {
  Radios() : small(3), peers(equipped()) {
    peers.join("p", "robot[02]");
    peers.join("q", "robot1");
    peers.publish(5);
    peers.inboxes.clear();
  }

  const SmallRun& equipped() {
    world::Layout& layout = small.layout();
    for (std::size_t i = 0; i < 3; ++i) {
      world::RadioLayout& radio = layout.radios.emplace_back();
      radio.id = "radio" + std::to_string(i);
      radio.sends = i != 2;
      radio.receives = true;
      layout.robots[i].radios = {i, 1};
    }
    return small;
  }
  static void send(v1::ClientMessage& command, std::uint32_t radio, const std::string& payload) {
    v1::RadioMessage& message = *command.mutable_command()->add_radio_messages();
    message.set_radio(radio);
    message.set_payload(payload);
  }
  v1::Error faulted(const v1::ClientMessage& message) {
    peers.say("p", message);
    const v1::ServerMessage told = peers.told("p");
    EXPECT_TRUE(told.has_error());
    EXPECT_EQ(told.error().severity(), v1::Error::DISCARD);
    EXPECT_EQ(told.error().field(), "radio_messages");
    EXPECT_EQ(told.error().tick(), 5U);
    EXPECT_TRUE(peers.commands.radio_messages.entries.empty());
    return told.error();
  }
  std::vector<std::size_t> senders() const {
    std::vector<std::size_t> result;
    for (const auto& entry : peers.commands.radio_messages.entries) result.push_back(entry.radio);
    return result;
  }

  SmallRun small;
  Peers peers;
};

TEST_F(Radios, D1_NumbersCountTheRadiosOfTheSession) {
  auto command = Peers::command(5);
  command.mutable_command()->add_robots(0);
  send(command, 0, "x");
  peers.say("p", command);
  auto other = Peers::command(5);
  send(other, 0, "y");
  peers.say("q", other);
  EXPECT_TRUE(peers.is_complete());
  EXPECT_EQ(senders(), (std::vector<std::size_t>{0, 1}));
}

TEST_F(Radios, D1_RadiosThatAreNotTheSessionsToUse) {
  for (const std::uint32_t radio : {2U, 1'000'000'000U, ~0U}) {
    auto command = Peers::command(5);
    send(command, 0, "fine");
    send(command, radio, "x");
    EXPECT_EQ(faulted(command).code(), v1::Error::UNKNOWN_DEVICE);
  }
  auto command = Peers::command(5);
  send(command, 1, "x");
  auto error = faulted(command);
  EXPECT_EQ(error.code(), v1::Error::UNKNOWN_DEVICE);
  EXPECT_EQ(error.robot(), "robot2") << "which has no actuator for radios";
  command = Peers::command(5);
  command.mutable_command()->add_robots(1);
  send(command, 0, "x");
  error = faulted(command);
  EXPECT_EQ(error.code(), v1::Error::NOT_YOURS);
  EXPECT_EQ(error.robot(), "robot0");
  peers.say("p", Peers::command(5));
  EXPECT_TRUE(peers.told("p").message_case() == v1::ServerMessage::MESSAGE_NOT_SET)
      << "the session lives";
}

TEST_F(Radios, D1_MessagesOfRobotsThatLeftAreIgnored) {
  peers.say("p", Peers::leave({0}));
  auto command = Peers::command(5);
  send(command, 0, "x");
  peers.say("p", command);
  EXPECT_TRUE(peers.inboxes["p"].empty());
  EXPECT_TRUE(senders().empty());
}

TEST_F(Radios, D2_Limits) {
  auto command = Peers::command(5);
  send(command, 0, std::string(world::most_radio_message_bytes + 1, 'x'));
  if (!talks_json()) {
    EXPECT_EQ(faulted(command).code(), v1::Error::TOO_LARGE);
  }
  command = Peers::command(5);
  const std::size_t longest = talks_json() ? 64 << 10 : world::most_radio_message_bytes;  // JSON: by T4
  for (int i = 0; i < 2; ++i) send(command, 0, std::string(longest, 'x'));
  peers.say("p", command);
  EXPECT_EQ(senders().size(), 2U);
}

TEST_F(Radios, K5_SmallMessagesInGreatNumbersAreTooLarge) {
  auto command = Peers::command(5);
  for (int i = 0; i < 60'000; ++i) send(command, 0, "x");
  peers.say("p", command);
  EXPECT_EQ(peers.told("p").error().code(), v1::Error::TOO_LARGE);
  command.mutable_command()->mutable_radio_messages()->DeleteSubrange(0, talks_json() ? 58'500 : 45'000);
  peers.say("p", command);
  EXPECT_EQ(senders().size(), talks_json() ? 1500U : 15'000U);
}

TEST_F(Radios, D3_MessagesComeInTheOrderOfTheWorld) {
  world::Observations seen = small.observations(6);
  const auto hear = [&](std::size_t radio, const std::string& text) {
    seen.radio_messages.add(radio,
                            {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  };
  hear(0, "first");
  hear(0, "");
  hear(1, "for q");
  hear(2, "last");
  peers.publish(seen);
  const auto messages = peers.told("p").observation().radio_messages();
  ASSERT_EQ(messages.size(), 3);
  EXPECT_EQ(messages[0].payload(), "first");
  EXPECT_EQ(messages[1].payload(), "");
  EXPECT_EQ(messages[2].payload(), "last");
  EXPECT_EQ(messages[2].radio(), 1U);
}

TEST_F(Radios, D5_ASessionThatWouldHearTooMuchIsLost) {
  world::Observations seen = small.observations(6);
  const std::string text(world::most_radio_message_bytes, 'x');
  seen.radio_messages.add(0, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  const auto entry = seen.radio_messages.entries.front();
  seen.radio_messages.entries.assign(1025, entry);
  peers.publish(seen);
  const auto error = peers.told("p").error();
  EXPECT_EQ(error.code(), v1::Error::TOO_LARGE);
  EXPECT_EQ(error.severity(), v1::Error::FATAL);
  const auto notices = peers.take_report().notices;
  ASSERT_EQ(notices.size(), 1U);
  EXPECT_NE(notices[0].find("is lost: its robots heard and saw more at a tick than a message can hold; share them among more sessions"), std::string::npos) << notices[0];
  EXPECT_EQ(peers.told("q").observation().tick(), 6U);
  EXPECT_FALSE(peers.is_complete());
}

/// Two robots with wheels and turret, and a camera each that sees tags and takes pictures of
/// 2 x 1 pixels; the second robot only measures. "p" holds both and owes tick 5.
struct DrivingAndCameras : ::testing::Test {
  DrivingAndCameras() : small(2), peers(equipped()) {
    peers.commands.wheels.resize(2);
    peers.commands.turret_modes.resize(2);
    peers.commands.turret_rotations.resize(2);
    peers.commands.turret_speeds.resize(2);
    peers.join("p", "robot*");
    peers.publish(sight(5));
    peers.inboxes.clear();
  }

  const SmallRun& equipped() {
    world::Layout& layout = small.layout();
    layout.wheels = {{0, 0.14, true, true}, {1, 0.14, false, true}};
    layout.turrets = {{0, true, true}, {1, false, true}};
    layout.cameras.resize(2);
    layout.tags.resize(2);
    for (std::size_t i = 0; i < 2; ++i) {
      layout.cameras[i].tags.emplace();
      layout.cameras[i].resolution = {2, 1};
      layout.cameras[i].image = true;
      layout.robots[i].cameras = {i, 1};
      layout.robots[i].wheels = {i, 1};
      layout.robots[i].turrets = {i, 1};
    }
    return small;
  }
  world::Observations sight(std::uint64_t tick) const {
    world::Observations seen = small.observations(tick);
    seen.wheels.resize(2);
    seen.turrets.resize(2);
    return seen;
  }
  static world::TagReading tag(std::size_t camera, std::size_t tag) {
    world::TagReading reading{camera, tag, {10, 20}, {}};
    reading.corners.fill({30, 40});
    return reading;
  }
  v1::Error faulted(const v1::ClientMessage& message) {
    peers.say("p", message);
    const v1::ServerMessage told = peers.told("p");
    EXPECT_TRUE(told.has_error());
    EXPECT_EQ(told.error().severity(), v1::Error::DISCARD);
    EXPECT_EQ(told.error().tick(), 5U);
    EXPECT_EQ(peers.commands.wheels[0].left, 0);
    EXPECT_EQ(peers.commands.turret_modes[0], world::TurretMode::passive);
    return told.error();
  }
  static v1::ClientMessage drive(std::vector<double> velocities) {
    auto message = Peers::command(5);
    message.mutable_command()->mutable_wheel_velocities()->Add(velocities.begin(),
                                                               velocities.end());
    return message;
  }

  SmallRun small;
  Peers peers;
};

TEST_F(DrivingAndCameras, D6_TwoSpeedsPerRobotThatDrives) {
  for (const std::vector<double>& wrong :
       {std::vector<double>{1}, {1, 2, 3}, {1, 2, 3, 4}, {1, std::nan("")}, {1 / 0.0, 1}}) {
    const auto error = faulted(drive(wrong));
    EXPECT_EQ(error.code(), v1::Error::BAD_VALUE);
    EXPECT_EQ(error.field(), "wheel_velocities");
  }
  peers.say("p", drive({0.5, -0.5}));
  EXPECT_TRUE(peers.is_complete());
  EXPECT_EQ(peers.commands.wheels[0].right, -0.5);
  EXPECT_EQ(peers.commands.wheels[1].right, 0);
}

TEST_F(DrivingAndCameras, D7_TurretsTakeTheModesThereAre) {
  const auto turn = [](std::vector<int> modes) {
    auto message = drive({1, 1});
    for (const int mode : modes) {
      message.mutable_command()->add_turret_modes(static_cast<v1::TurretMode>(mode));
    }
    return message;
  };
  for (const std::vector<int>& wrong : {std::vector<int>{0}, {4}, {-1}, {2, 2}}) {
    const auto error = faulted(turn(wrong));
    EXPECT_EQ(error.code(), v1::Error::BAD_VALUE);
    EXPECT_EQ(error.field(), "turret_modes");
  }
  auto message = turn({v1::TURRET_SPEED});
  message.mutable_command()->add_turret_rotations(std::nan(""));
  EXPECT_EQ(faulted(message).field(), "turret_rotations");
  message.mutable_command()->set_turret_rotations(0, 1);
  for (const double speed : {0.0, 1 / 0.0}) message.mutable_command()->add_turret_speeds(speed);
  EXPECT_EQ(faulted(message).field(), "turret_speeds");
  message.mutable_command()->mutable_turret_speeds()->RemoveLast();
  peers.say("p", message);
  EXPECT_TRUE(peers.is_complete());
  EXPECT_EQ(peers.commands.turret_modes[0], world::TurretMode::speed);
}

TEST_F(DrivingAndCameras, D8_DetectorsCountPerCamera) {
  world::Observations seen = sight(6);
  seen.tags = {tag(1, 1), tag(1, 0)};
  seen.images = {{0, {1, 2, 3, 4, 5, 6}}, {1, {}}};
  peers.publish(seen, {"zero", "one"});
  const auto told = peers.told("p").observation();
  ASSERT_EQ(told.tag_counts_size(), 2);
  EXPECT_EQ(told.tag_counts(0), 0U);
  EXPECT_EQ(told.tag_counts(1), 2U);
  EXPECT_EQ(told.tag_payloads(0), "one");
  EXPECT_EQ(told.tag_centers_size(), 4);
  EXPECT_EQ(told.tag_corners_size(), 16);
  ASSERT_EQ(told.camera_images_size(), 2);
  EXPECT_EQ(told.camera_images(0).size(), 6U);
  EXPECT_EQ(told.camera_images(1).size(), 0U);
}

TEST_F(DrivingAndCameras, D5_PicturesAndPayloadsCount) {
  world::Observations seen = sight(6);
  seen.tags.assign(std::size_t{1} << 14, tag(0, 0));
  seen.images = {{0, {1, 2, 3, 4, 5, 6}}};
  peers.publish(seen, std::vector<std::string>(2, std::string(64 << 10, 'x')));
  const auto error = peers.told("p").error();
  EXPECT_EQ(error.code(), v1::Error::TOO_LARGE);
  EXPECT_EQ(error.severity(), v1::Error::FATAL);
}

TEST_F(DrivingAndCameras, L1_ARobotThatLeavesStands) {
  peers.commands.turret_speeds[0] = 3;
  peers.say("p", drive({0.5, 0.5}));
  peers.publish(sight(6));
  peers.say("p", Peers::leave({0}));
  peers.say("p", Peers::command(6));
  zero_missing(peers.barrier, peers.commands);
  EXPECT_EQ(peers.commands.wheels[0].left, 0);
  EXPECT_EQ(peers.commands.turret_speeds[0], 0);
}

TEST(ContactSensors, D10_FiveValuesEach) {
  SmallRun small(2);
  small.layout().contact_sensors.resize(2);
  small.layout().robots[1].contact_sensors = {1, 1};
  Peers peers(small);
  peers.join("p", "robot*");
  peers.inboxes.clear();
  world::Observations seen = small.observations(5);
  seen.contact_sensors.resize(2);
  seen.contact_sensors[1] = {1, {2, 3, 4}, 9};
  peers.publish(seen);
  const auto told = peers.told("p").observation();
  ASSERT_EQ(told.contact_sensors_size(), 5);
  EXPECT_EQ(told.contact_sensors(0), 1);
  EXPECT_EQ(told.contact_sensors(4), 9);
}

TEST(Imus, D9_SixValuesEach) {
  SmallRun small(2);
  small.layout().imus.resize(3);
  small.layout().robots[0].imus = {0, 1};
  small.layout().robots[1].imus = {1, 2};
  Peers peers(small);
  peers.join("p", "robot1");
  peers.inboxes.clear();
  world::Observations seen = small.observations(5);
  seen.imus.resize(3);
  seen.imus[1].acceleration[0] = 3;
  seen.imus[2].angular_velocity[2] = 7;
  peers.publish(seen);
  const auto told = peers.told("p").observation();
  ASSERT_EQ(told.imus_size(), 12);
  EXPECT_EQ(told.imus(0), 3);
  EXPECT_EQ(told.imus(11), 7);
}

}  // namespace
}  // namespace ziggurat::network
