// SPDX-License-Identifier: MIT
#include "wire/read_json.h"

#include <gtest/gtest.h>

#include <string>

#include "ziggurat/v1/json.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {
namespace {

TEST(ReadJson, WhatProtobufReadsToo) {
  for (const std::string text : {
           R"({})",
           R"({"command":{}})",
           R"({"command":null,"leave":{}})",
           R"({"hello":{"version":{"major":1,"minor":4294967295},"role":"ROLE_CONTROLLER",
              "robots":["a","\u00e9\ud83d\ude00"],"luaOnly":true,"clientName":"x\u0000y",
              "deadlinePolicy":{"action":"HOLD","wallDeadlineMs":"7"}}})",
           R"({"hello":{"role":1,"takeover":false,"sessionToken":"AQIDBA=="}})",
           R"({"hello":{"role":"1","sessionToken":"AQIDBA"}})",
           R"({"hello":{"session_token":"-_8="}})",
           R"({"hello":{"sessionToken":"+/8=","controller":null}})",
           R"({"command":{"tick":"18446744073709551615","robots":[0,"1",2.0,3e0]}})",
           R"({"command":{"tick":18446744073709551615}})",
           R"({"command":{"tick":1.8e19}})",
           R"({"command":{"jointTargets":[1,-2,0.5,"-0.5","NaN","Infinity","-Infinity",1e-400,
              1e308,12345678901234567890123456789,4.9e-324,-0.0]}})",
           R"({"command":{"turretModes":["TURRET_SPEED",2,77],"ledColors":[16777215]}})",
           R"({"command":{"radioMessages":[{"radio":3,"payload":"aGVsbG8="},{},{"payload":""}],
              "log":[{"robot":1,"error":true,"text":"line"}],"unknown":[{"a":[1,{}]},null]}})",
           R"({"command":{"log":null,"tagPayloads":["","AA==","AAA=","AAAA"]}})",
           R"({"leave":{"reason":"FAILED","message":"m","robots":[]}})",
           R"({"request":{"id":"9","move":{"entity":"e","position":[1,2,3]}}})",
           R"({"request":{"id":9,"read":{"entities":["*"]}},"other":1})",
       }) {
    SCOPED_TRACE(text);
    v1::ClientMessage message, expected;
    ASSERT_EQ(v1::from_json(text, expected), "");
    EXPECT_EQ(read_json(text, message), "");
    EXPECT_EQ(message.SerializeAsString(), expected.SerializeAsString());
  }
}

TEST(ReadJson, AnUnknownNameOfAnEnumerationIsAsAnUnknownNumber) {
  v1::ClientMessage message;
  EXPECT_EQ(read_json(R"({"hello":{"deadlinePolicy":{"action":"STOPP"}}})", message), "");
  EXPECT_EQ(static_cast<int>(message.hello().deadline_policy().action()), -1);
  message.Clear();
  EXPECT_EQ(read_json(R"({"command":{"turretModes":["TURRET_SPED","TURRET_SPEED"]}})", message),
            "");
  ASSERT_EQ(message.command().turret_modes_size(), 2) << "the others keep their places";
  EXPECT_EQ(message.command().turret_modes(0), -1);
}

TEST(ReadJson, TellsWhichFieldCannotHaveItsValue) {
  const auto complaint = [](const std::string& text) {
    v1::ClientMessage message;
    return read_json(text, message);
  };
  for (const std::string value :
       {"-1", "18446744073709551616", "1.5", "1e20", "\"x\"", "\"\"", "\"1.0\"", "\" 1\"", "\"-1\"",
        "\"1e3\"", "\"18446744073709551616\""}) {
    EXPECT_EQ(complaint("{\"command\":{\"tick\":" + value + "}}"), "'tick' can't have that value")
        << value;
  }
  for (const std::string value : {"-1", "4294967296", "0.5", "\"a\""}) {
    EXPECT_EQ(complaint("{\"command\":{\"robots\":[" + value + "]}}"),
              "'robots' can't have that value")
        << value;
  }
  for (const std::string value :
       {"\"\"", "\"1,5\"", "\"inf\"", "\"nan\"", "\"1e999\"", "\"0x10\"", "\" 1\"", "\"1 \""}) {
    EXPECT_EQ(complaint("{\"command\":{\"jointTargets\":[" + value + "]}}"),
              "'joint_targets' can't have that value")
        << value;
  }
  for (const std::string value : {"A", "A===", "AA=A", "A*==", "AB==", "AAB=", "=", "A A="}) {
    EXPECT_EQ(complaint("{\"hello\":{\"sessionToken\":\"" + value + "\"}}"),
              "'session_token' can't have that value")
        << value;
  }
  EXPECT_EQ(complaint(R"({"hello":{"role":4294967296}})"), "'role' can't have that value");
  EXPECT_EQ(complaint(R"({"command":{},"leave":{}})"),
            "it has 'leave' beside another kind of message");
  EXPECT_EQ(complaint(R"({"request":{"pause":{},"resume":{}}})"),
            "it has 'resume' beside another kind of request");
  EXPECT_EQ(complaint(R"({"command":)"), "not JSON at byte 12");
  EXPECT_EQ(complaint(std::string(R"({"leave":{}})") + '\0' + R"({"command":{}})"),
            "not JSON at byte 13");
}

}  // namespace
}  // namespace ziggurat::wire
