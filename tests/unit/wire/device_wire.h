// SPDX-License-Identifier: MIT
#pragma once
// A session of an EquippedRun: what it commands and what it is told.

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "wire/equipped_run.h"
#include "wire/inbox.h"
#include "wire/outbox.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

inline std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

inline std::string text_of(std::span<const std::uint8_t> bytes) {
  return {bytes.begin(), bytes.end()};
}

/// A session of these robots of an EquippedRun.
struct DeviceWire : ::testing::Test {
  explicit DeviceWire(std::vector<std::size_t> robots = {0, 1, 2})
      : roster(make_roster(run.layout(), robots)), commands(run.commands()) {
    command = message.mutable_command();
  }

  std::optional<Fault> check() {
    EXPECT_EQ(inbox.parse(message.SerializeAsString()), Inbox::Kind::command);
    return inbox.check(roster, run.layout());
  }
  void apply() {
    const auto fault = check();
    ASSERT_FALSE(fault) << fault->message;
    inbox.apply(roster, commands);
  }
  void expect_fault(ErrorCode code, const std::string& field, const std::string& robot,
                    const std::string& words) {
    const auto fault = check();
    ASSERT_TRUE(fault) << command->ShortDebugString().substr(0, 200);
    EXPECT_EQ(fault->code, code) << fault->message;
    EXPECT_EQ(fault->severity, Severity::discard);
    EXPECT_EQ(fault->field, field);
    EXPECT_EQ(fault->robot, robot);
    EXPECT_NE(fault->message.find(words), std::string::npos) << fault->message;
    command->Clear();
  }
  void send(std::uint32_t radio, const std::string& payload) {
    v1::RadioMessage& sent = *command->add_radio_messages();
    sent.set_radio(radio);
    sent.set_payload(payload);
  }
  v1::Observation told(const world::Observations& seen,
                       const std::vector<std::string>& tag_payloads = {}) {
    Outbox outbox;
    EXPECT_TRUE(outbox.observation(roster, seen, tag_payloads));
    return told(outbox).observation();
  }
  v1::ServerMessage told(const Outbox& outbox) {
    std::string bytes(outbox.size(), '\0');
    outbox.write(reinterpret_cast<std::uint8_t*>(bytes.data()));
    v1::ServerMessage told;
    EXPECT_TRUE(told.ParseFromString(bytes));
    return told;
  }
  std::vector<std::pair<std::size_t, std::string>> sent() const {
    std::vector<std::pair<std::size_t, std::string>> result;
    for (const auto& entry : commands.radio_messages.entries) {
      result.emplace_back(entry.radio, text_of(commands.radio_messages.payload(entry)));
    }
    return result;
  }
  using Sent = std::vector<std::pair<std::size_t, std::string>>;

  EquippedRun run;
  Roster roster;
  world::Commands commands;
  Inbox inbox;
  v1::ClientMessage message;
  v1::Command* command;
};

/// A session of c alone.
struct DeviceWireOfC : DeviceWire {
  DeviceWireOfC() : DeviceWire({2}) {}
};

}  // namespace ziggurat::wire
