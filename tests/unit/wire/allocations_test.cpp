// SPDX-License-Identifier: MIT
// Messages of a tick are written, read and applied without an allocation.

#include "allocations/allocations.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "network/small_run.h"
#include "wire/equipped_run.h"
#include "wire/inbox.h"
#include "wire/outbox.h"
#include "wire/roster.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {
namespace {

using network::SmallRun;

TEST(TickPath, AllocatesNothingOnceItHasGrown) {
  const SmallRun small(64);
  const auto run = small.run();
  std::vector<std::size_t> robots(64);
  for (std::size_t i = 0; i < robots.size(); ++i) robots[i] = i;
  const Roster roster = make_roster(run.layout, robots);
  const auto observations = small.observations(5);
  auto commands = small.commands();
  v1::ClientMessage answer;
  answer.mutable_command()->set_tick(5);
  for (int i = 0; i < 64; ++i) answer.mutable_command()->add_joint_targets(i);
  const std::string bytes = answer.SerializeAsString();
  Outbox outbox;
  Inbox inbox;
  std::string buffer(10'000, '\0');
  const auto tick = [&] {
    outbox.observation(roster, observations, {});
    outbox.write(reinterpret_cast<std::uint8_t*>(buffer.data()));
    if (inbox.parse(bytes) != Inbox::Kind::command) std::abort();
    if (inbox.check(roster, run.layout)) std::abort();
    inbox.apply(roster, commands);
  };
  tick();
  const std::size_t before = testing::allocations();
  for (int i = 0; i < 100; ++i) tick();
  EXPECT_EQ(testing::allocations(), before);
  EXPECT_EQ(commands.joint_targets[63], 63);
}

TEST(TickPath, DevicesAllocateNothingEither) {
  const EquippedRun run;
  const std::vector<std::size_t> robots{0, 1, 2};
  const Roster roster = make_roster(run.layout(), robots);
  auto commands = run.commands();
  auto observations = run.observations();
  const std::vector<std::uint8_t> payload(100, 7);
  for (int i = 0; i < 5; ++i) observations.radio_messages.add(3, payload);
  const std::vector<std::string> tags(4, std::string(50, 'x'));
  observations.leds.assign(3, {0, 0xFF, {1, 2}});
  world::TagReading tag{2, 3, {1, 2}, {}};
  tag.corners.fill({3, 4});
  observations.tags.assign(5, tag);
  observations.images = {{0, std::vector<std::uint8_t>(6)}};
  v1::ClientMessage answer;
  v1::Command& command = *answer.mutable_command();
  for (int i = 0; i < 3; ++i) {
    command.add_led_colors(1);
    command.add_tag_payloads(std::string(50, 'x'));
    v1::RadioMessage& message = *command.add_radio_messages();
    message.set_payload(std::string(100, 'x'));
  }
  for (int i = 0; i < 4; ++i) command.add_wheel_velocities(i);
  for (int i = 0; i < 2; ++i) command.add_turret_modes(v1::TURRET_SPEED);
  const std::string bytes = answer.SerializeAsString();
  Outbox outbox;
  Inbox inbox;
  const auto tick = [&] {
    commands.radio_messages.clear();
    if (!outbox.observation(roster, observations, tags)) std::abort();
    if (inbox.parse(bytes) != Inbox::Kind::command) std::abort();
    if (inbox.check(roster, run.layout())) std::abort();
    inbox.apply(roster, commands);
  };
  tick();
  const std::size_t before = testing::allocations();
  for (int i = 0; i < 100; ++i) tick();
  EXPECT_EQ(testing::allocations(), before);
  EXPECT_EQ(commands.radio_messages.entries.size(), 3U);
}

}  // namespace
}  // namespace ziggurat::wire
