// What the worst messages cost that are decoded: bench/results/disturbances.md has the figures.

#include <gtest/gtest.h>
#include <time.h>

#include <cstdio>
#include <string>

#include "long_runs.h"
#include "wire/cost.h"
#include "wire/inbox.h"
#include "wire/longest_command.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {
namespace {

/// Of this thread [s].
double processor_time() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// As many of `unit` between the others as a Command of robots without radios may have.
std::string json_of(const std::string& begin, const std::string& unit, const std::string& end,
                    std::size_t most = command_allowance, std::size_t longest = command_allowance) {
  std::string text = begin;
  text.reserve(longest);
  for (std::size_t i = 0; i < most; ++i) {
    if (text.size() + unit.size() + end.size() > longest) break;
    text += unit;
  }
  return text + end;
}

std::string text_in_binary() {
  v1::ClientMessage message;
  std::string& text = *message.mutable_command()->add_log()->mutable_text();
  while (text.size() + 100 < command_allowance) text += "\xe2\x82\xac";
  return message.SerializeAsString();
}

std::string many_messages_in_binary() {
  v1::ClientMessage message;
  for (std::size_t i = 0; i + 2 < most_fields; ++i) message.mutable_command()->add_radio_messages();
  return message.SerializeAsString();
}

/// As many as a Command of robots with radios may have.
std::string long_messages_in_binary() {
  v1::ClientMessage message;
  for (int i = 0; i < 63; ++i) {
    message.mutable_command()->add_radio_messages()->set_payload(std::string(1 << 20, 'x'));
  }
  return message.SerializeAsString();
}

TEST(Decoding, TheWorstMessagesTakeLessThanASecond) {
  const struct {
    const char* name;
    std::string bytes;
  } messages[] = {
      {"text in binary", text_in_binary()},
      {"radio messages in binary", many_messages_in_binary()},
      {"the longest in binary", long_messages_in_binary()},
      {"the longest in JSON", json_of(R"({"command":{"tagPayloads":[")", "AAAA", R"("]}})", 6 << 20, 24 << 20)},
      {"text in JSON", json_of(R"({"command":{"log":[{"text":")", "\xe2\x82\xac", R"("}]}})")},
      {"bytes in JSON", json_of(R"({"command":{"tagPayloads":[")", "AAAA", R"("]}})")},
      {"numbers in JSON",
       json_of(R"({"command":{"jointTargets":[0)", ",0.12345678901", "]}}", most_fields - 10)},
      {"objects in JSON", json_of(R"({"command":{"log":[{})", R"(,{"robot":0})", "]}}", most_fields / 2 - 9)},
      {"one number in JSON", json_of(R"({"command":{"jointTargets":[0.)", "12345678", "]}}")},
  };
  for (const auto& [name, bytes] : messages) {
    Inbox inbox;
    const double begin = processor_time();
    EXPECT_EQ(inbox.parse(bytes), Inbox::Kind::command) << name << ": " << inbox.complaint();
    const double used = processor_time() - begin;
    std::printf("%-26s %4.1f MiB %6.1f ms\n", name, static_cast<double>(bytes.size()) / (1 << 20), 1e3 * used);
    EXPECT_LT(used, long_runs::is_slow ? 20 : 1) << name;
  }
}

}  // namespace
}  // namespace ziggurat::wire
