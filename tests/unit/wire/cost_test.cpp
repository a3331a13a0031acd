// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <malloc.h>

#include <functional>

#include "wire/command_limits.h"
#include "wire/inbox.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {
namespace {

TEST(Cost, FieldsAreCountedInMessagesOfMessages) {
  v1::ClientMessage message;
  EXPECT_EQ(count_fields(message.SerializeAsString()), 0U);
  message.mutable_command()->set_tick(7);
  for (int i = 0; i < 1000; ++i) message.mutable_command()->add_joint_targets(i);
  EXPECT_EQ(count_fields(message.SerializeAsString()), 3U) << "an array is one";
  for (int i = 0; i < 10; ++i) {
    auto& line = *message.mutable_command()->add_log();
    line.set_robot(1);
    line.set_text("x");
  }
  EXPECT_EQ(count_fields(message.SerializeAsString()), 3U + 30U);
}

TEST(Cost, AMessageOfEmptyPartsIsNotDecoded) {
  const std::string payloads = [] {
    v1::ClientMessage message;
    for (std::size_t i = 0; i <= most_fields; ++i) message.mutable_command()->add_tag_payloads();
    return message.SerializeAsString();
  }();
  Inbox inbox;
  EXPECT_EQ(inbox.parse(payloads), Inbox::Kind::malformed);
  EXPECT_NE(inbox.complaint(), "");
  std::string unknown = "\x12\xff\xff\xff\x1f";  // a Command of unknown fields
  while (unknown.size() < 4'000'000) unknown += "\x78\x01";
  EXPECT_GT(count_fields(unknown.substr(5)), most_fields);
  std::string json = R"({"command":{"tagPayloads":[)";
  for (std::size_t i = 0; i <= most_fields; ++i) json += "\"\",";
  EXPECT_EQ(inbox.parse(json + "\"\"]}}"), Inbox::Kind::malformed);
}

/// Memory that this process holds for objects [bytes].
std::size_t allocated() {
  const struct mallinfo2 info = ::mallinfo2();
  return info.uordblks + info.hblkhd;
}

TEST(Cost, AFieldTakesAHundredBytesOfMemory) {
  using Add = std::function<void(v1::ClientMessage&)>;
  const std::pair<const char*, Add> kinds[] = {
      {"log", [](auto& to) { to.mutable_command()->add_log(); }},
      {"metrics", [](auto& to) { to.mutable_command()->add_metrics(); }},
      {"radio messages", [](auto& to) { to.mutable_command()->add_radio_messages(); }},
      {"tag payloads", [](auto& to) { to.mutable_command()->add_tag_payloads(); }},
      {"robots", [](auto& to) { to.mutable_hello()->add_robots(); }},
      {"entities", [](auto& to) { to.mutable_request()->mutable_read()->add_entities(); }},
      {"acts", [](auto& to) { to.mutable_direction()->add_acts(); }},
      {"pushes", [](auto& to) { to.mutable_direction()->add_acts()->mutable_push(); }},
      {"paints", [](auto& to) { to.mutable_direction()->add_acts()->mutable_paint_floor(); }},
      {"moves", [](auto& to) { to.mutable_direction()->add_acts()->mutable_move(); }},
      {"spawns", [](auto& to) { to.mutable_direction()->add_acts()->mutable_spawn(); }},
  };
  for (const auto& [name, add] : kinds) {
    v1::ClientMessage message;
    std::string bytes;
    std::size_t fields = 0;
    for (int i = 0; i < 10'000; ++i) add(message);
    fields = count_fields(message.SerializeAsString());
    ASSERT_GE(fields, 10'000U) << name;
    for (std::size_t i = 10'000; i < 10'000 * most_fields / fields - 10; ++i) add(message);
    bytes = message.SerializeAsString();
    fields = count_fields(bytes);
    ASSERT_LE(fields, most_fields) << name;
    ASSERT_GT(fields, most_fields * 9 / 10) << name;
    const std::size_t before = allocated();
    Inbox inbox;
    ASSERT_NE(inbox.parse(bytes), Inbox::Kind::malformed) << name << ": " << inbox.complaint();
    const std::size_t taken = allocated() - before;
    RecordProperty(name, static_cast<int>(taken / fields));
    EXPECT_LT(taken, 100 * fields) << name;
  }
}

TEST(Cost, CommasInATextOfJsonAreNoValues) {
  EXPECT_EQ(count_json_values(R"({"command":{"log":[{"text":"[1,2,3], \",{\"\\"},{}]}})"), 6U);
}

TEST(Cost, ListsOfNumbersCountByTheirLength) {
  v1::ClientMessage message;
  for (int i = 0; i < 1600; ++i) message.mutable_command()->add_led_colors(1);
  for (int i = 0; i < 1600; ++i) message.mutable_command()->add_joint_targets(1);
  EXPECT_EQ(count_fields(message.SerializeAsString()), 1U + 2U + 1600 / bytes_per_field);
}

TEST(Cost, TextCountsByItsLength) {
  v1::ClientMessage message;
  message.mutable_command()->add_log()->set_text(std::string(16 << 10, 'x'));
  message.mutable_command()->add_tag_payloads(std::string(16 << 10, 'x'));
  EXPECT_EQ(count_fields(message.SerializeAsString()), 4U + (16 << 10) / bytes_per_field);
  message.mutable_command()->mutable_log(0)->set_text(
      std::string(most_fields * bytes_per_field, 'x'));
  Inbox inbox;
  EXPECT_EQ(inbox.parse(message.SerializeAsString()), Inbox::Kind::malformed);
}

TEST(Cost, AnyBytesEnd) {
  EXPECT_EQ(count_fields("\xff\xff\xff"), 0U);
  EXPECT_EQ(count_fields(std::string("\x0a\x7f", 2)), 0U);
  EXPECT_EQ(count_fields(std::string(100, '\x0b')), 100U) << "groups";
  EXPECT_EQ(count_fields(std::string("\x80\x80\x80\x80\x80\x80\x80\x80\x80\x80\x80", 11)), 0U);
}

}  // namespace
}  // namespace ziggurat::wire
