// SPDX-License-Identifier: MIT
// Messages to directors and their answers (docs/protocol.md, R3 to R11). The effect of their acts
// on a world is tested by tests/scenes/directing_test.py.

#include <gtest/gtest.h>

#include <limits>

#include "directed_run.h"
#include "wire/messages.h"

namespace ziggurat::network {
namespace {

using std::chrono::milliseconds;

TEST_F(Directing, R3_ADirectorIsToldWhatItSubscribedTo) {
  auto hello = director("judge");
  hello.mutable_hello()->mutable_subscription()->add_entities("b[1-9]");
  hello.mutable_hello()->mutable_subscription()->add_groups(v1::Subscription::LEDS);
  peers.say("p", hello);
  peers.inboxes.clear();
  publish(5);
  auto messages = told();
  ASSERT_EQ(messages.size(), 2U);
  EXPECT_EQ(messages[0].world_layout().entities_size(), 1);
  EXPECT_EQ(messages[0].world_layout().entities(0).id(), "b1");
  EXPECT_EQ(messages[0].world_layout().entities(0).kind(), "box");
  EXPECT_EQ(messages[0].world_layout().entities(0).leds(0).color(), 7U);
  const v1::WorldState& state = messages[1].world_state();
  ASSERT_EQ(state.poses_size(), 7);
  EXPECT_EQ(state.poses(0), 1);
  EXPECT_EQ(state.poses(3), 1);
  EXPECT_EQ(state.led_colors(0), 1U);
  EXPECT_TRUE(state.links().empty());
  EXPECT_TRUE(state.joints().empty());
}

TEST_F(Directing, R5_ALayoutThatNoMessageCanHoldIsAFatalError) {
  boxes = Boxes(65);
  for (auto& entity : boxes.layout.entities) entity.id += std::string(1 << 20, 'x');
  peers.json = true;  // which has 64 MiB
  peers.say("p", director("judge"));
  peers.inboxes.clear();
  publish(5);
  const auto messages = told();
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(messages[0].error().code(), v1::Error::TOO_LARGE);
  EXPECT_EQ(messages[0].error().severity(), v1::Error::FATAL);
  EXPECT_EQ(messages[0].error().field(), "subscription");
}

TEST_F(Directing, R3_ASubscriptionHas64PatternsOf256Bytes) {
  auto hello = director("judge");
  for (int i = 0; i < 64; ++i) hello.mutable_hello()->mutable_subscription()->add_entities("b*");
  auto more = hello;
  more.mutable_hello()->mutable_subscription()->add_entities("b*");
  EXPECT_EQ(refused(peers, more).code(), v1::Error::TOO_MANY);
  auto longer = director("judge");
  longer.mutable_hello()->mutable_subscription()->add_entities(std::string(257, 'b'));
  EXPECT_EQ(refused(peers, longer).code(), v1::Error::TOO_MANY);
  peers.say("p", hello);
  const auto welcome = peers.told("p").welcome();
  ASSERT_FALSE(welcome.session_token().empty());
  more.mutable_hello()->set_session_token(welcome.session_token());
  peers.say("r", more);
  EXPECT_EQ(peers.told("r").refusal().error().code(), v1::Error::TOO_MANY) << "also to resume";
}

TEST_F(Directing, R4_ALayoutThatDidNotArriveIsToldAgain) {
  begin();
  peers.say("p", direction(5));
  peers.say("q", direction(5));
  boxes.add();
  peers.congested.insert("q");
  publish(6);
  peers.congested.clear();
  peers.say("c", Peers::command(6));
  peers.say("p", direction(6));
  peers.pass(milliseconds(60));
  ASSERT_TRUE(peers.is_complete()) << "it has missed the tick";
  peers.inboxes.clear();
  publish(7);
  const auto& told = peers.inboxes["q"];
  ASSERT_EQ(told.size(), 2U);
  EXPECT_EQ(told[0].world_layout().first(), 0U);
  EXPECT_EQ(told[0].world_layout().entities_size(), 3);
  EXPECT_EQ(told[1].world_state().poses_size(), 21);
}

TEST_F(Directing, R5_ContactsAreToldByTheirLinks) {
  auto hello = director("judge");
  hello.mutable_hello()->mutable_subscription()->add_entities("b1");
  hello.mutable_hello()->mutable_subscription()->add_groups(v1::Subscription::CONTACTS);
  peers.say("p", hello);
  boxes.contacts.emplace_back().link = 0;
  boxes.contacts.push_back(
      {.link = 0, .other = 1, .point = {1, 2, 3}, .normal = {0, 0, 1}, .force = {0, 0, 5}});
  boxes.contacts.emplace_back().link = 1;
  peers.inboxes.clear();
  publish(5);
  const v1::WorldState state = told().back().world_state();
  EXPECT_EQ((std::vector<int>{state.contact_links().begin(), state.contact_links().end()}),
            (std::vector<int>{0, -2, 0, -1}))
      << "b0 is not told: the contact is turned round; that of b0 with the floor is left out";
  EXPECT_EQ(state.contacts(2), 3);
  EXPECT_EQ(state.contacts(5), -1);
  EXPECT_EQ(state.contacts(8), -5);
}

TEST_F(Directing, R8_ValuesThatAreShownAreBounded) {
  begin();
  auto show = direction(5);
  show.mutable_direction()->add_acts()->mutable_show()->add_led_colors(0x1000000);
  EXPECT_EQ(faulted(peers, show).code(), v1::Error::BAD_VALUE);
  show.mutable_direction()->mutable_acts(0)->mutable_show()->clear_led_colors();
  show.mutable_direction()->mutable_acts(0)->mutable_show()->add_tag_payloads(
      std::string(65537, 'x'));
  EXPECT_EQ(faulted(peers, show).code(), v1::Error::TOO_LARGE);
}

TEST_F(Directing, K5_ADirectionHas10000ActsAnd1000Lines) {
  begin();
  auto lines = direction(5);
  for (int i = 0; i < 1001; ++i) lines.mutable_direction()->add_log();
  EXPECT_EQ(faulted(peers, lines).code(), v1::Error::TOO_MANY);
  auto acts = direction(5);
  for (int i = 0; i < 10001; ++i)
    acts.mutable_direction()->add_acts()->mutable_push()->set_entity("b0");
  EXPECT_EQ(faulted(peers, acts).code(), v1::Error::TOO_MANY);
  acts.mutable_direction()->mutable_acts()->RemoveLast();
  peers.say("p", acts);
  EXPECT_EQ(answered(), Ids{"judge"});
}

TEST_F(Directing, K5_ADirectionHas4MiB) {
  peers.say("p", director("judge"));
  EXPECT_EQ(peers.told("p").welcome().max_message_bytes(), 4U << 20);
  publish(5);
  peers.inboxes.clear();
  auto spawn = direction(5);
  spawn.mutable_direction()->add_acts()->mutable_spawn()->set_xml(std::string(4 << 20, ' '));
  EXPECT_EQ(faulted(peers, spawn).code(), v1::Error::TOO_LARGE);
  spawn.mutable_direction()->mutable_acts(0)->mutable_spawn()->set_xml(
      std::string((1 << 20) - 100, ' '));
  peers.say("p", spawn);
  EXPECT_EQ(answered(), Ids{"judge"});
}

TEST_F(Directing, K5_ADirectionSpawns1000Entities) {
  begin();
  auto spawns = direction(5);
  for (int i = 0; i < 1001; ++i)
    spawns.mutable_direction()->add_acts()->mutable_spawn()->set_xml("<box />");
  const auto error = faulted(peers, spawns);
  EXPECT_EQ(error.code(), v1::Error::TOO_MANY);
  EXPECT_NE(error.message().find("1000"), std::string::npos);
  spawns.mutable_direction()->mutable_acts()->RemoveLast();
  peers.say("p", spawns);
  EXPECT_EQ(answered(), Ids{"judge"});
}

TEST_F(Directing, R9_MetricsAndLinesStandUnderTheIdOfTheDirector) {
  begin();
  auto message = direction(5);
  v1::Metric& metric = *message.mutable_direction()->add_metrics();
  metric.set_robot(77);
  metric.set_name("food");
  metric.set_value(3);
  message.mutable_direction()->add_log()->set_text("hello");
  peers.say("p", message);
  const auto metrics = metrics_of_tick(peers.barrier);
  ASSERT_EQ(metrics.size(), 1U);
  EXPECT_EQ(world::key_of(metrics[0]), "judge/food");
  const auto log = peers.take_report().log_of_directors;
  ASSERT_EQ(log.size(), 1U);
  EXPECT_EQ(log[0].director, "judge");
  EXPECT_EQ(log[0].text, "hello");
  metric.set_name("no name");
  publish(6);
  peers.inboxes.clear();
  message.mutable_direction()->set_tick(6);
  EXPECT_EQ(faulted(peers, message).code(), v1::Error::BAD_VALUE);
}

TEST_F(Directing, R9_ALeaveHasTheLastWords) {
  begin();
  auto leave = Peers::leave({}, v1::Leave::FAILED);
  leave.mutable_leave()->set_message("no food");
  leave.mutable_leave()->add_log()->set_text("good bye");
  v1::Metric& metric = *leave.mutable_leave()->add_metrics();
  metric.set_name("food");
  auto wrong = leave;
  wrong.mutable_leave()->add_robots(0);
  EXPECT_EQ(faulted(peers, wrong).code(), v1::Error::UNKNOWN_ROBOT);
  peers.say("p", leave);
  const Report report = peers.take_report();
  ASSERT_EQ(report.failed_directors.size(), 1U);
  EXPECT_EQ(report.failed_directors[0].message, "no food");
  EXPECT_EQ(report.log_of_directors.size(), 1U);
  EXPECT_EQ(peers.barrier.directors.metrics.last().size(), 1U);
  peers.say("q", direction(5));
  EXPECT_TRUE(peers.is_complete());
}

TEST_F(Directing, R9_ADirectionCountsAlthoughItsDirectorLeaves) {
  begin();
  peers.say("p", direction(5));
  peers.say("p", Peers::leave());
  peers.say("q", direction(5));
  EXPECT_TRUE(peers.is_complete());
  EXPECT_EQ(answered(), (Ids{"hasty", "judge"}));
}

TEST_F(Directing, V12_AStatusNamesThem) {
  begin();
  wire::Status status;
  fill(peers.barrier, peers.now, status);
  ASSERT_EQ(status.sessions.size(), 3U);
  EXPECT_EQ(status.sessions[1].director, "judge");
  EXPECT_EQ(status.sessions[2].deadline.wall_deadline_ms, 50U);
}

}  // namespace
}  // namespace ziggurat::network
