// SPDX-License-Identifier: MIT
// Radios of scripts: what they receive and send, and their limits. A script's fault fails its
// assert.

#include <gtest/gtest.h>

#include "lua_devices.h"

namespace ziggurat::lua {
namespace {

/// Messages of one radio, each as the values of its bytes.
std::vector<std::vector<int>> messages_of(const v1::Command& command, std::uint32_t radio) {
  std::vector<std::vector<int>> messages;
  for (const v1::RadioMessage& message : command.radio_messages()) {
    if (message.radio() != radio) continue;
    auto& bytes = messages.emplace_back();
    for (const char byte : message.payload()) bytes.push_back(static_cast<unsigned char>(byte));
  }
  return messages;
}

void add_received(v1::Observation& seen, std::uint32_t radio, const std::string& payload) {
  seen.add_radio_messages()->set_radio(radio);
  seen.mutable_radio_messages()->rbegin()->set_payload(payload);
}

TEST_F(Devices, RadioMessagesAreArraysOfIntegers) {
  add_radio(robot_, "a", {.receives = true});
  add_radio(robot_, "b", {.receives = true});
  EXPECT_RUNS(start(R"lua(
    a, b = robot.radios.a.rx_data, robot.radios.b.rx_data
    function step()
      assert(a == robot.radios.a.rx_data, "the table is the same at every tick")
      expect()
    end
    function expect()
      assert(#a == 2 and #a[1] == 3 and #a[2] == 0 and #b == 0)
      assert(a[1][1] == 0 and a[1][3] == 255 and math.type(a[1][3]) == "integer")
      assert(a[1][3] + 1 .. "" == "256")
      kept = a[1]
      function expect()
        assert(#a == 1 and a[2] == nil and a[1][1] == 7, "earlier messages are removed")
        assert(#kept == 3, "but may be kept")
        function expect() assert(next(a) == nil) end
      end
    end
  )lua"));
  add_received(seen(), 0, std::string("\0\x80\xff", 3));
  add_received(seen(), 0, "");
  EXPECT_RUNS(step());
  seen().clear_radio_messages();
  add_received(seen(), 0, "\7");
  EXPECT_RUNS(step());
  seen().clear_radio_messages();
  EXPECT_RUNS(step());
}

TEST_F(Devices, RadioNumbersBecomeBytes) {
  add_radio(robot_, "r", {.sends = true});
  EXPECT_RUNS(start(R"lua(
    local tx = robot.radios.r.tx_data
    tx({0, 255, 256, 257, -1, -256, -257})
    tx({2.7, -0.9, -1.9, 255.99, 1e300, -2.0^53 - 2, 2^63, math.mininteger, math.maxinteger})
    tx({})
    tx({n = 1, 5})
  )lua"));
  EXPECT_EQ(messages_of(command(), 0),
            (std::vector<std::vector<int>>{
                {0, 255, 0, 1, 255, 0, 255}, {2, 0, 255, 255, 0, 254, 0, 0, 255}, {}, {5}}));
}

TEST_F(Devices, RadioRefusesInvalidMessages) {
  add_radio(robot_, "r", {.sends = true});
  EXPECT_RUNS(start(R"lua(
    local tx = robot.radios.r.tx_data
    refused("tx_data%(table%) expected, got 0", tx)
    refused("tx_data%(table%) expected, got 2", tx, {1}, {2})
    refused("table expected, got string", tx, "text")
    refused("table expected, got nil", tx, nil)
    refused("element 2 of the table, got string", tx, {1, "2"})
    refused("element 1 of the table, got boolean", tx, {true})
    refused("element 3 of the table, got inf or nan", tx, {1, 2, 0/0})
    refused("element 1 of the table, got inf or nan", tx, {math.huge})
    tx({9})
  )lua"));
  EXPECT_EQ(messages_of(command(), 0), (std::vector<std::vector<int>>{{9}}));
}

TEST_F(Devices, RadioMessagesMayBeLongAndMany) {
  add_radio(robot_, "r", {.sends = true});
  EXPECT_RUNS(start(R"lua(
    local long = {}
    for i = 1, 65536 do long[i] = i end
    robot.radios.r.tx_data(long)
    for i = 1, 1000 do robot.radios.r.tx_data({i}) end
  )lua"));
  const auto messages = messages_of(command(), 0);
  ASSERT_EQ(messages.size(), 1001U);
  EXPECT_EQ(messages[0].size(), 65536U);
  EXPECT_EQ(messages[1000], std::vector<int>{1000 % 256});
}

TEST_F(Devices, RadioLimitsAreErrorsThatAScriptMayCatch) {
  add_radio(robot_, "r", {.sends = true});
  add_radio(robot_, "s", {.sends = true});
  EXPECT_RUNS(start(R"lua(
    local r, s = robot.radios.r.tx_data, robot.radios.s.tx_data
    local long = {}
    for i = 1, 1 << 20 do long[i] = 0 end
    for i = 1, 8 do r(long) s(long) end
    refused("sends 16777217 bytes at this tick; at most 16777216 are allowed", r, {1})
    for i = 17, 65536 do s({}) end
    refused("sends 65537 messages at this tick; at most 65536 are allowed", r, {})
    long[#long + 1] = 0
    refused("a message of 1048577 bytes; at most 1048576 are allowed", r, long)
  )lua"));
  EXPECT_EQ(messages_of(command(), 0).size(), 8U);
}

}  // namespace
}  // namespace ziggurat::lua
