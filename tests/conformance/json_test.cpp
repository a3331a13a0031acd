// SPDX-License-Identifier: MIT
// Rule T6 of docs/protocol.md, the JSON twin. The kit plays its cases in both forms; here is what
// depends on the text itself.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "network/peers.h"

namespace ziggurat::network {
namespace {

using nlohmann::json;

/// A barrier whose peers talk in literal text.
struct Twin : ::testing::Test {
  Twin()
      : small(2),
        barrier({},
                [this](const std::string& peer, const auto& message) {
                  if (peer == dead) return Delivery::unreachable;
                  std::string bytes(message.size(), '\0');
                  message.write(reinterpret_cast<std::uint8_t*>(bytes.data()));
                  inboxes[peer].push_back(bytes);
                  return Delivery::sent;
                },
                {}) {
    network::open(barrier, small.run(), {});
  }

  void say(const std::string& peer, const std::string& bytes) {
    receive(barrier, {.connection = peer, .bytes = bytes}, &commands);
  }
  void publish(std::uint64_t tick) {
    observations = small.observations(tick);
    network::publish(barrier, observations, payloads);
  }
  /// The last thing that the peer was told, which must be JSON.
  json told(const std::string& peer) {
    const auto messages = std::exchange(inboxes[peer], {});
    return messages.empty() ? json() : json::parse(messages.back());
  }
  void join(const std::string& peer, const std::string& robots = "*") {
    say(peer, R"({"hello":{"version":{"major":1},"role":"ROLE_CONTROLLER","robots":[")" + robots +
                  R"("]}})");
  }

  SmallRun small;
  std::string dead;  // a peer whose connection is gone
  std::map<std::string, std::vector<std::string>> inboxes;
  world::Commands commands = small.commands();
  world::Observations observations;
  const std::vector<std::string> payloads;
  Barrier barrier;
};

TEST_F(Twin, T6_MalformedTextIsAnsweredInJson) {
  std::string deep = R"({"hello":{"x":)" + std::string(100'000, '[');
  for (const std::string& text :
       {std::string("{"), std::string("{}"), std::string("{}{}"), std::string(R"({"hello":)"),
        std::string(R"({"nothing":{}})"), std::string(R"({"hello":7})"), std::string("{\0}", 3),
        std::string(R"({"command":{"tick":-1}})"), std::string(R"({"command":{"tick":"x"}})"),
        std::string(R"({"command":{"tick":1e30}})"),
        std::string("{\"leave\":{\"message\":\"\xff\"}}"),
        std::string(R"({"command":{},"leave":{}})"), deep}) {
    SCOPED_TRACE(text.substr(0, 40));
    say("unknown", text);
    const json error = told("unknown")["error"];
    EXPECT_EQ(error["code"], "MALFORMED");
    EXPECT_EQ(error["severity"], "FATAL");
    EXPECT_LT(error["message"].get<std::string>().size(), 500U);
  }
}

TEST_F(Twin, T6_WhatIsNotJsonIsMalformed) {
  const std::string start = R"({"hello":{"version":{"major":1},"role":"ROLE_CONTROLLER","robots":)";
  for (const std::string& text : {
           std::string("{'hello':{}}"),
           std::string("{hello:{}}"),
           start + R"(["*"],}})",
           start + R"(["*",]}})",
           start + R"(['*']}})",
           start + "[*]}}",
           start + R"(["*"]},})",
           start + R"(["*"]}} x)",
           start + R"(["*"]}} // no comments)",
           start + R"(["*"]},"unknown":+1})",
           start + R"(["*"]},"unknown":01})",
           start + R"(["*"]},"unknown":.5})",
           start + R"(["*"]},"unknown":True})",
           start + R"(["*"]},"unknown":"\x41"})",
           start + "[\"*\"]},\"unknown\":\"line\nfeed\"}",
       }) {
    SCOPED_TRACE(text);
    say("unknown", text);
    EXPECT_EQ(told("unknown")["error"]["code"], "MALFORMED");
  }
}

TEST_F(Twin, T6_WhatDoesNotMatchTheMessageIsMalformed) {
  const std::string start = R"({"hello":{"version":{"major":1},"role":"ROLE_CONTROLLER",)";
  for (const std::string& text : {
           start + R"("robots":"*"}})",         // a text for a list
           start + R"("robots":[["*"]]}})",     // a list for a text
           start + R"("robots":["*",null]}})",  // nothing for a text
           start + R"("robots":[7]}})",         // a number for a text
           start + R"("robots":{"0":"*"}}})",   // an object for a list
           start + R"("robots":["*"],"takeover":"true"}})",
           start + R"("robots":["*"],"takeover":1}})",
           start + R"("robots":["*"],"clientName":7}})",
           start + R"("robots":["*"],"clientName":["me"]}})",
           start + R"("robots":["*"],"robots":["robot0"]}})",  // twice
           start + R"("robots":["*"],"clientName":"a","client_name":"b"}})",
           std::string(R"({"command":{"jointTargets":[true]}})"),
           std::string(R"({"command":{"log":{"text":"one"}}})"),
           std::string(R"({"command":[{"tick":"0"}]})"),
           std::string(R"({"leave":"DONE"})"),
       }) {
    SCOPED_TRACE(text);
    say("unknown", text);
    EXPECT_EQ(told("unknown")["error"]["code"], "MALFORMED");
  }
}

TEST_F(Twin, T6_DepthIsBounded) {
  const auto nested = [](std::size_t levels) {
    return R"({"later":)" + std::string(levels, '[') + std::string(levels, ']') +
           R"(,"heartbeat":{}})";
  };
  join("p");
  inboxes.clear();
  say("p", nested(63));
  EXPECT_TRUE(told("p").contains("heartbeat"));
  say("p", nested(64));
  EXPECT_EQ(told("p")["error"]["code"], "MALFORMED");
}

TEST_F(Twin, T6_SeveralFramesAreAnsweredInTheFormOfTheFirst) {
  for (const auto form : {wire::Encoding::json, wire::Encoding::binary}) {
    receive(
        barrier,
        {.connection = "unknown", .bytes = "x", .is_single_frame = false, .several_frames = form},
        &commands);
    EXPECT_EQ(inboxes["unknown"].back().starts_with('{'), form == wire::Encoding::json);
  }
  join("p");
  receive(barrier, {.connection = "p", .bytes = "x", .is_single_frame = false}, &commands);
  EXPECT_EQ(told("p")["error"]["code"], "MALFORMED") << "in the session's form";
}

TEST_F(Twin, T6_ABinarySessionMayResumeInJson) {
  say("p", bytes_of(Peers::hello("*"), wire::Encoding::binary));
  const auto token = message_of(inboxes["p"].at(0)).welcome().session_token();
  publish(4);
  dead = "p";
  v1::ClientMessage hello = Peers::hello("*");
  hello.mutable_hello()->set_session_token(token);
  say("q", bytes_of(hello, wire::Encoding::json));
  ASSERT_EQ(inboxes["q"].size(), 2U);
  EXPECT_EQ(told("q")["observation"]["tick"], "4");
  say("q", R"({"command":{"tick":"4"}})");
  EXPECT_TRUE(barrier.gate.is_complete());
}

TEST_F(Twin, S8_NumbersAreFiniteInJsonToo) {
  join("p");
  publish(0);
  for (const char* number : {"\"NaN\"", "\"Infinity\"", "\"-Infinity\""}) {
    say("p", std::string(R"({"command":{"tick":"0","jointTargets":[0,)") + number + "]}}");
    EXPECT_EQ(told("p")["error"]["code"], "BAD_VALUE") << number;
  }
  // Not JSON at all.
  for (const char* number : {"NaN", "1e999"}) {
    say("p", std::string(R"({"command":{"tick":"0","jointTargets":[0,)") + number + "]}}");
    EXPECT_EQ(told("p")["error"]["code"], "MALFORMED") << number;
  }
}

TEST(TwinOfAll, T6_EveryAnswerComesInTheFormOfTheSession) {
  for (const bool in_json : {false, true}) {
    const SmallRun small(2);
    Peers peers(small);
    peers.json = in_json;
    peers.join("p", "*");
    peers.publish(3);
    peers.say("p", Peers::command(7));
    peers.say("p", Peers::heartbeat(5));
    peers.say("p", Peers::hello("*"));
    peers.say("unknown", Peers::command(7));
    peers.say("late", Peers::hello("*"));
    peers.probe();
    finish(peers.barrier, {});
    EXPECT_EQ(peers.inboxes["p"].size(), 7U);
    EXPECT_EQ(peers.inboxes["late"].size(), 1U);
    EXPECT_TRUE(peers.told_otherwise.empty());
  }
}

}  // namespace
}  // namespace ziggurat::network
