// SPDX-License-Identifier: MIT
// Cost of the worst messages that are decoded: bench/results/disturbances.md has the figures.

#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "long_runs.h"
#include "wire/command_limits.h"
#include "wire/inbox.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {
namespace {

/// Processor time of this thread [s].
double processor_time() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// As many of `unit` between the others as fit.
std::string json_of(const CommandLimits& limits, const std::string& begin, const std::string& unit,
                    const std::string& end) {
  std::string text = begin;
  const std::size_t per_unit = std::max<std::size_t>(1, count_json_values(unit));
  const bool is_text = begin.back() == '"';
  const std::size_t most = is_text ? limits.bytes : limits.fields / per_unit - 4;
  for (std::size_t i = 0; i < most && text.size() + unit.size() + end.size() <= limits.bytes; ++i)
    text += unit;
  return text + end;
}

std::string text_in_binary(const CommandLimits& limits) {
  v1::ClientMessage message;
  std::string& text = *message.mutable_command()->add_log()->mutable_text();
  while (text.size() + 100 < limits.bytes) text += "\xe2\x82\xac";
  return message.SerializeAsString();
}

std::string many_messages_in_binary(const CommandLimits& limits) {
  v1::ClientMessage message;
  for (std::size_t i = 0; i + 2 < limits.fields; ++i)
    message.mutable_command()->add_radio_messages();
  return message.SerializeAsString();
}

std::string long_messages_in_binary(const CommandLimits& limits) {
  v1::ClientMessage message;
  for (std::size_t left = limits.bytes - 100; left > 0;) {
    const std::size_t size = std::min<std::size_t>(left, 1 << 20);
    message.mutable_command()->add_radio_messages()->set_payload(std::string(size, 'x'));
    left -= size;
  }
  return message.SerializeAsString();
}

/// Layout of a robot with a radio and every device that a Command has values for.
world::Layout equipped() {
  world::Layout layout;
  layout.radios.resize(1);
  layout.radios[0].sends = true;
  layout.robots.resize(1);
  layout.robots[0].radios = {0, 1};
  layout.robots[0].tags = {0, 1};
  layout.robots[0].leds = {0, 12};
  layout.robots[0].joint_actuators = {0, 12};
  return layout;
}

CommandLimits limits_of(const world::Layout& layout, Encoding encoding) {
  Roster roster;
  for (std::size_t i = 0; i < layout.robots.size(); ++i) roster.robots.push_back(i);
  return command_limits(roster, layout, encoding);
}

TEST(Decoding, ALimitHasPlaceForTheMetricsOfAllRobots) {
  constexpr unsigned robots = 100, metrics = 100;
  world::Layout layout;
  layout.robots.resize(robots);
  v1::ClientMessage message;
  for (unsigned i = 0; i < robots * metrics; ++i) {
    v1::Metric& metric = *message.mutable_command()->add_metrics();
    metric.set_robot(i / metrics);
    metric.set_name(std::string(64, 'x'));
    metric.set_value(-1.2345678901234567e-100);
  }
  const CommandLimits binary = limits_of(layout, Encoding::binary),
                      json = limits_of(layout, Encoding::json);
  const std::string bytes = message.SerializeAsString();
  EXPECT_LE(bytes.size(), binary.bytes);
  EXPECT_LE(count_fields(bytes), binary.fields);
  std::string text;
  ASSERT_TRUE(google::protobuf::util::MessageToJsonString(message, &text).ok());
  EXPECT_LE(text.size(), json.bytes);
  EXPECT_LE(count_json_values(text), json.fields);
}

TEST(Decoding, ALimitHasPlaceForManyLogLinesAndRadioMessagesOfARobot) {
  world::Layout layout;
  layout.radios.resize(1);
  layout.radios[0].sends = true;
  layout.robots.resize(1);
  layout.robots[0].radios = {0, 1};
  const CommandLimits limits = limits_of(layout, Encoding::binary);
  v1::ClientMessage message;  // as the client in C++ counts: 64 bytes for a line, 96 for a message
  for (std::size_t bytes = 0; bytes + 65 <= 258U << 10; bytes += 65) {
    v1::LogLine& line = *message.mutable_command()->add_log();
    line.set_robot(1);
    line.set_error(true);
    line.set_text("x");
  }
  for (std::size_t bytes = 0; bytes + 97 <= limits.bytes / 2; bytes += 97) {
    v1::RadioMessage& sent = *message.mutable_command()->add_radio_messages();
    sent.set_radio(1);
    sent.set_payload("x");
  }
  const std::string bytes = message.SerializeAsString();
  EXPECT_LE(bytes.size(), limits.bytes);
  EXPECT_LE(count_fields(bytes), limits.fields);
}

TEST(Decoding, TheWorstCommandOfARobotTakesAFewMilliseconds) {
  const world::Layout layout = equipped();
  const CommandLimits binary = limits_of(layout, Encoding::binary),
                      json = limits_of(layout, Encoding::json);
  EXPECT_LT(binary.bytes, std::size_t{3} << 20);
  EXPECT_LT(json.bytes, std::size_t{1} << 19);
  const struct {
    const char* name;
    std::string bytes;
    std::size_t fields;
  } messages[] = {
      {"text in binary", text_in_binary(limits_of({}, Encoding::binary)), binary.fields},
      {"radio messages in binary", many_messages_in_binary(binary), binary.fields},
      {"the longest in binary", long_messages_in_binary(binary), binary.fields},
      {"text in JSON", json_of(json, R"({"command":{"log":[{"text":")", "\xe2\x82\xac", R"("}]}})"),
       json.fields},
      {"bytes in JSON", json_of(json, R"({"command":{"tagPayloads":[")", "AAAA", R"("]}})"),
       json.fields},
      {"numbers in JSON",
       json_of(json, R"({"command":{"jointTargets":[0)", ",0.12345678901", "]}}"), json.fields},
      {"objects in JSON", json_of(json, R"({"command":{"log":[{})", R"(,{"robot":0})", "]}}"),
       json.fields},
      {"one number in JSON", json_of(json, R"({"command":{"jointTargets":[0.)", "12345678", "]}}"),
       json.fields},
  };
  for (const auto& [name, bytes, fields] : messages) {
    Inbox inbox;
    const double begin = processor_time();
    EXPECT_EQ(inbox.parse(bytes, fields), Inbox::Kind::command)
        << name << ": " << inbox.complaint();
    const double used = processor_time() - begin;
    std::printf("%-26s %4.2f MiB %6.2f ms\n", name, static_cast<double>(bytes.size()) / (1 << 20),
                1e3 * used);
    EXPECT_LT(used, long_runs::is_slow ? 2 : 0.1) << name;
  }
}

}  // namespace
}  // namespace ziggurat::wire
