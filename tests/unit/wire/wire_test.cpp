// SPDX-License-Identifier: MIT
// Bytes and packing, which the conformance tests do not see.

#include <gtest/gtest.h>

#include <limits>
#include <optional>

#include "network/small_run.h"
#include "wire/command.h"
#include "wire/equipped_run.h"
#include "wire/inbox.h"
#include "wire/outbox.h"
#include "wire/roster.h"
#include "ziggurat/v1/envelope.h"
#include "ziggurat/v1/json.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {
namespace {

using network::SmallRun;

std::string bytes_of(const Outbox& outbox) {
  std::string bytes(outbox.size(), '\0');
  outbox.write(reinterpret_cast<std::uint8_t*>(bytes.data()));
  return bytes;
}

const Packing& joint_readings(const Roster& roster) {
  return roster.sensed[world::row_of(world::sensed, &world::Observations::joint_readings)];
}

TEST(Roster, NeighboursAreCopiedInOnePiece) {
  SmallRun small(6);
  const std::vector<std::size_t> robots{0, 1, 2, 4, 5};
  const Roster roster = make_roster(small.layout(), robots);
  const Packing& readings = joint_readings(roster);
  ASSERT_EQ(readings.stretches.size(), 2U);
  EXPECT_EQ(readings.stretches[1].packed, 3U);
  EXPECT_EQ(readings.stretches[1].flat, 4U);
  EXPECT_EQ(readings.stretches[1].count, 2U);
  EXPECT_EQ(readings.count, 5U);
}

TEST(Roster, RobotsWithoutJointsAreSkipped) {
  SmallRun small(3);
  small.layout().robots[1].joint_sensors = {0, 0};
  const std::vector<std::size_t> robots{0, 1, 2};
  const Roster roster = make_roster(small.layout(), robots);
  const Packing& readings = joint_readings(roster);
  EXPECT_EQ(readings.count, 2U);
  EXPECT_EQ(readings.robots[2].packed, 1U);
}

TEST(Outbox, ObservationBytes) {
  const SmallRun small(2);
  const std::vector<std::size_t> robots{1};
  const auto run = small.run();
  Outbox outbox;
  outbox.observation(make_roster(run.layout, robots), small.observations(3), {});
  v1::ServerMessage message;
  ASSERT_TRUE(message.ParseFromString(bytes_of(outbox)));
  EXPECT_EQ(message.observation().tick(), 3U);
  ASSERT_EQ(message.observation().joint_readings_size(), 1);
  EXPECT_EQ(message.observation().joint_readings(0), 301);
}

TEST(Outbox, InvalidTextOfASceneIsMadeValid) {
  SmallRun small(1);
  small.layout().robots[0].params = {{"name", "caf\xe9"}};
  const auto run = small.run();
  const std::vector<std::size_t> robots{0};
  Outbox outbox;
  outbox.welcome(run, make_roster(run.layout, robots),
                 Welcome{"token", 0, Role::controller, 0, 0, {}});
  v1::ServerMessage message;
  ASSERT_TRUE(message.ParseFromString(bytes_of(outbox)));
  EXPECT_EQ(message.welcome().robots(0).params(0).value(), "caf\xEF\xBF\xBD");
}

TEST(RadioMessages, ThoseOfARosterAreForgotten) {
  const EquippedRun run;
  const auto kept = [&](const std::vector<std::size_t>& robots,
                        std::optional<std::size_t> taken = {}) {
    Roster roster = make_roster(run.layout(), robots);
    if (taken) roster.hand_over(*taken);
    world::RadioMessages messages;
    for (const std::uint8_t radio : {3, 0, 1, 2, 0})
      messages.add(radio, std::vector<std::uint8_t>{radio});
    forget_radio_messages(roster, messages);
    std::string text;
    for (const auto& entry : messages.entries)
      text += static_cast<char>('0' + messages.payload(entry)[0]);
    EXPECT_EQ(messages.bytes.size(), text.size());
    return text;
  };
  EXPECT_EQ(kept({0, 1}), "32");
  EXPECT_EQ(kept({1, 2}), "010");
  EXPECT_EQ(kept({1}), "30120");
  EXPECT_EQ(kept({0, 1, 2}), "");
  EXPECT_EQ(kept({0, 1, 2}, 0), "010") << "another session has the first robot";
}

TEST(Inbox, ASecondCommandIsNotMixedWithTheFirst) {
  Inbox inbox;
  v1::ClientMessage message;
  message.mutable_command()->set_tick(7);
  message.mutable_command()->add_joint_targets(1);
  ASSERT_EQ(inbox.parse(message.SerializeAsString()), Inbox::Kind::command);
  EXPECT_EQ(inbox.command_tick(), 7U);
  message.mutable_command()->Clear();
  ASSERT_EQ(inbox.parse(message.SerializeAsString()), Inbox::Kind::command);
  EXPECT_EQ(inbox.command_tick(), 0U);
  EXPECT_EQ(inbox.parse(""), Inbox::Kind::malformed);
}

TEST(Inbox, ACommandBehindAnUnknownFieldIsACommand) {
  Inbox inbox;
  v1::ClientMessage message;
  message.mutable_command()->set_tick(7);
  // Field 15, varint 1, then the command.
  EXPECT_EQ(inbox.parse("\x78\x01" + message.SerializeAsString()), Inbox::Kind::command);
  EXPECT_EQ(inbox.command_tick(), 7U);
}

TEST(Inbox, TruncatedBytesAreMalformed) {
  v1::ClientMessage message;
  message.mutable_command()->set_tick(1000);
  for (int i = 0; i < 40; ++i) message.mutable_command()->add_joint_targets(i);
  message.mutable_command()->add_log()->set_text("text");
  const std::string bytes = message.SerializeAsString();
  Inbox inbox;
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    EXPECT_EQ(inbox.parse(bytes.substr(0, length)), Inbox::Kind::malformed) << length;
  }
  EXPECT_EQ(inbox.parse(bytes), Inbox::Kind::command);
}

TEST(Inbox, JsonIsTheSameMessage) {
  Inbox inbox;
  ASSERT_EQ(inbox.parse(R"({"command":{"tick":"7","jointTargets":[1]}})"), Inbox::Kind::command);
  EXPECT_EQ(inbox.command_tick(), 7U);
  EXPECT_EQ(inbox.parse(R"({"heartbeat":{"sequence":"18446744073709551615"}})"),
            Inbox::Kind::heartbeat);
  EXPECT_EQ(inbox.heartbeat(), ~std::uint64_t{0});
  EXPECT_EQ(inbox.complaint(), "");
  EXPECT_EQ(inbox.parse(R"({"command":{"tick":"7","jointTargets":[1]})"), Inbox::Kind::malformed);
  EXPECT_NE(inbox.complaint(), "");
  EXPECT_EQ(inbox.parse(" {}"), Inbox::Kind::malformed);
  EXPECT_EQ(inbox.complaint(), "it is neither protobuf nor JSON, which begins with '{'");
  EXPECT_EQ(inbox.parse(R"({"helo":{}})"), Inbox::Kind::malformed);
  EXPECT_EQ(inbox.complaint(), "it has none of the messages that clients send");
}

TEST(Inbox, WhatIsNoMessageIsToldAsSuch) {
  using namespace std::string_literals;
  Inbox inbox;
  for (const std::string& bytes : {"\xff\xff"s, "[]"s, "\x12\x02\x0a\xff"s}) {
    EXPECT_EQ(inbox.parse(bytes), Inbox::Kind::malformed);
    EXPECT_EQ(inbox.complaint(), "it is neither protobuf nor JSON, which begins with '{'") << bytes;
  }
  EXPECT_EQ(inbox.parse(""), Inbox::Kind::malformed);
  EXPECT_EQ(inbox.complaint(), "it has none of the messages that clients send");
}

TEST(Inbox, InvalidUtf8IsMalformedAndNothingIsPrinted) {
  Inbox inbox;
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(inbox.parse("\x0a\x03\x22\x01\xff"), Inbox::Kind::malformed);
  EXPECT_EQ(inbox.parse("{\"hello\":{\"controller\":\"\xff\"}}"), Inbox::Kind::malformed);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "") << "peers do not write on our terminal";
}

TEST(Inbox, TruncatedJsonIsMalformed) {
  v1::ClientMessage message;
  message.mutable_command()->set_tick(1000);
  message.mutable_command()->add_log()->set_text("\" h\xc3\xa9 \\");
  message.mutable_command()->add_tag_payloads("\xff\x01");
  const std::string text = v1::to_json(message);
  Inbox inbox;
  for (std::size_t length = 0; length < text.size(); ++length) {
    EXPECT_EQ(inbox.parse(text.substr(0, length)), Inbox::Kind::malformed) << length;
  }
  EXPECT_EQ(inbox.parse(text), Inbox::Kind::command);
}

TEST(Inbox, NoBinaryMessageOfOursBeginsAsJsonDoes) {
  const auto& fields = *v1::ClientMessage::descriptor();
  for (int i = 0; i < fields.field_count(); ++i) {
    v1::ClientMessage message;
    message.GetReflection()->MutableMessage(&message, fields.field(i));
    EXPECT_NE(message.SerializeAsString()[0], '{') << fields.field(i)->name();
  }
}

TEST(Outbox, TakesTheFormThatIsAskedFor) {
  Outbox outbox;
  outbox.end({EndReason::failed, "\xff \"", 9});
  const std::string binary = bytes_of(outbox);
  outbox.encode(Encoding::json);
  EXPECT_EQ(bytes_of(outbox), R"({"end":{"reason":"FAILED","message":"� \"","tick":"9"}})");
  outbox.encode(Encoding::binary);
  EXPECT_EQ(bytes_of(outbox), binary);
  outbox.encode(Encoding::json);
  outbox.heartbeat(0);
  EXPECT_EQ(bytes_of(outbox)[0], 0x3a) << "a new message is binary again";
  outbox.encode(Encoding::json);
  EXPECT_EQ(bytes_of(outbox), R"({"heartbeat":{"sequence":"0"}})");
}

TEST(Outbox, InfiniteTimeOfABatteryIsAStringInJson) {
  const EquippedRun run;
  const std::vector<std::size_t> robots{0, 1, 2};
  auto observations = run.observations();
  ASSERT_FALSE(observations.batteries.empty());
  observations.batteries[0].time_left = std::numeric_limits<double>::infinity();
  Outbox outbox;
  ASSERT_TRUE(outbox.observation(make_roster(run.layout(), robots), observations, {}));
  outbox.encode(Encoding::json);
  EXPECT_NE(bytes_of(outbox).find("\"Infinity\""), std::string::npos);
  EXPECT_FALSE(outbox.observation(make_roster(run.layout(), robots), observations, {}, 10));
}

TEST(Envelope, SoleField) {
  EXPECT_EQ(v1::sole_field("\x12\x02xy", 2), "xy");
  EXPECT_EQ(v1::sole_field(std::string("\x12\x00", 2), 2), "");
  EXPECT_FALSE(v1::sole_field("\x12\x02xyz", 2));
  EXPECT_FALSE(v1::sole_field("\x12\x03xy", 2));
  EXPECT_FALSE(v1::sole_field("\x1a\x02xy", 2));
  EXPECT_FALSE(v1::sole_field("\x12", 2));
  EXPECT_FALSE(v1::sole_field("\x12\xff\xff\xff\xff\xff\xff\xff\xff", 2));
  EXPECT_EQ(v1::sole_field("\x12\xc8\x01" + std::string(200, 'x'), 2), std::string(200, 'x'));
}

TEST(Envelope, ValidUtf8) {
  EXPECT_EQ(v1::valid_utf8("h\xc3\xa9 \xe2\x82\xac \xf0\x9f\x90\x9c"),
            "h\xc3\xa9 \xe2\x82\xac \xf0\x9f\x90\x9c");
  const std::string mark = "\xEF\xBF\xBD";
  EXPECT_EQ(v1::valid_utf8("\xff"), mark);
  EXPECT_EQ(v1::valid_utf8("\xe2\x82"), mark + mark);
  EXPECT_EQ(v1::valid_utf8("\xc0\xaf"), mark + mark);                // overlong
  EXPECT_EQ(v1::valid_utf8("\xed\xa0\x80"), mark + mark + mark);     // surrogate
  EXPECT_EQ(v1::valid_utf8("\xf5\x80\x80\x80").substr(0, 3), mark);  // beyond U+10FFFF
}

}  // namespace
}  // namespace ziggurat::wire
