// SPDX-License-Identifier: MIT
// Who directs, and when: which version 1.4 of the protocol adds (docs/protocol.md, R1 and R2).

#include <gtest/gtest.h>

#include "directed_run.h"

namespace ziggurat::network {
namespace {

using std::chrono::milliseconds;

Config open_config() {
  Config config;
  config.allows_directors = true;
  return config;
}

struct DirectingFromOutside : Directing {
  DirectingFromOutside() : Directing(open_config()) {}
};

/// Policies of the command line, and a link that delays what the judge is told by 5 ms, and what it
/// answers.
struct DirectingByOptions : Directing {
  static Config make_config() {
    const Config::Deadline fixed{{scene::DeadlineAction::hold, 50, 0}, true};
    const Disturbance late{milliseconds(5), {}, 0};
    Config config = open_config();
    config.deadlines = {{}, {}, fixed, fixed};
    config.deadline_of_others = fixed;
    config.injections = {{}, {}, {late, late}, {}};
    return config;
  }
  DirectingByOptions() : Directing(make_config()) {}
};

TEST_F(DirectingFromOutside, R1_OneThatHasLeftMakesPlaceForAnother) {
  begin();
  const auto come = [&](const std::string& peer, const std::string& id) {
    peers.inboxes.clear();
    peers.say(peer, director(id));
    return peers.inboxes[peer].at(0);
  };
  EXPECT_TRUE(come("third", "third").has_welcome());
  for (int i = 0; i < 61; ++i) {
    const std::string id = "one" + std::to_string(i);
    ASSERT_TRUE(come(id, id).has_welcome()) << id;
    EXPECT_EQ(come("s", "another").refusal().error().code(), v1::Error::TOO_MANY);
    peers.say(id, Peers::leave());
    EXPECT_EQ(come("s", id).refusal().error().code(), v1::Error::NOT_YOURS);
  }
  const v1::Error refusal = come("s", "another").refusal().error();
  EXPECT_EQ(refusal.code(), v1::Error::TOO_MANY) << "64 in a run";
  EXPECT_FALSE(refusal.retryable());
}

TEST_F(DirectingFromOutside, R1_ItsIdIsThatOfNoEntity) {
  small.layout().entities.emplace_back().id = "robot0";
  Peers others(small, open_config());
  others.say("r", director("robot0"));
  EXPECT_EQ(others.told("r").refusal().error().code(), v1::Error::BAD_VALUE);
}

TEST_F(DirectingByOptions, H8_APolicyOfTheCommandLineIsFixedForDirectorsToo) {
  auto hello = director("judge");
  hello.mutable_hello()->mutable_deadline_policy()->set_action(v1::DeadlinePolicy::WAIT);
  EXPECT_EQ(refused(peers, hello).code(), v1::Error::FORBIDDEN);
  hello.mutable_hello()->set_director("from_outside");
  EXPECT_EQ(refused(peers, hello).code(), v1::Error::FORBIDDEN);
  peers.say("r", director("from_outside"));
  EXPECT_EQ(peers.told("r").welcome().deadline_policy().wall_deadline_ms(), 50U);
  peers.say("p", director("judge"));
  const v1::Welcome welcome = peers.told("p").welcome();
  EXPECT_EQ(welcome.deadline_policy().wall_deadline_ms(), 50U);
  hello.mutable_hello()->set_director("judge");
  hello.mutable_hello()->set_session_token(welcome.session_token());
  peers.say("s", hello);
  EXPECT_EQ(peers.told("s").refusal().error().code(), v1::Error::FORBIDDEN);
}

TEST_F(DirectingByOptions, R2_WhatADirectorIsToldAndAnswersIsDelayedToo) {
  peers.say("p", director("judge"));
  peers.say("q", director("hasty"));
  peers.inboxes.clear();
  publish(5);
  EXPECT_TRUE(told().back().has_world_layout()) << "its state comes later";
  EXPECT_EQ(peers.inboxes["q"].size(), 2U);
  peers.pass(milliseconds(5));
  EXPECT_TRUE(peers.told("p").has_world_state());
  peers.say("c", Peers::command(5));
  peers.say("q", direction(5));
  peers.say("p", direction(5));
  EXPECT_FALSE(peers.is_complete());
  peers.pass(milliseconds(5));
  EXPECT_TRUE(peers.is_complete());
}

TEST_F(Directing, R2_TheWorldWaitsForTheDirectorsOfItsScene) {
  EXPECT_FALSE(peers.is_gathered());
  peers.say("p", director("judge"));
  EXPECT_FALSE(peers.is_gathered());
  peers.say("q", director("hasty"));
  EXPECT_TRUE(peers.is_gathered());
}

TEST_F(Directing, R2_AnAnswerThatIsSentAgainReplacesTheOneBefore) {
  peers.say("p", director("judge"));
  const std::string token = peers.told("p").welcome().session_token();
  peers.say("q", director("hasty"));
  publish(5);
  peers.say("p", pushes(5, {1, 0, 0}));
  auto hello = director("judge");
  hello.mutable_hello()->set_session_token(token);
  peers.say("r", hello);
  peers.say("r", pushes(5, {2, 0, 0}));
  const auto all = directions(peers.barrier);
  ASSERT_EQ(all.size(), 1U);
  const auto& acts = all[0].direction.acts;
  ASSERT_EQ(acts.size(), 1U);
  EXPECT_EQ(std::get<wire::Push>(acts[0]).force[0], 2);
}

TEST_F(Directing, R2_AnAnswerOfBeforeIsNotThatOfATickThatIsMissed) {
  peers.say("p", director("judge"));
  peers.say("q", director("hasty"));
  const std::string token = peers.told("q").welcome().session_token();
  publish(5);
  peers.say("q", direction(5));
  auto hello = director("hasty");
  hello.mutable_hello()->set_session_token(token);
  peers.say("r", hello);
  peers.pass(milliseconds(60));
  EXPECT_EQ(answered(), Ids{});
}

}  // namespace
}  // namespace ziggurat::network
