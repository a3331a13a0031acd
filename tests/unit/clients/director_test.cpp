// SPDX-License-Identifier: MIT
// Directors against a server that the test scripts.

#include "ziggurat/director.h"

#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include "../long_runs.h"
#include "clients/fake_director.h"
#include "ziggurat/error.h"

namespace ziggurat {
namespace {

TEST(Director, IsToldOfTheWorldAndAnswers) {
  FakeServer server([](FakeServer& self) {
    const auto hello = self.receive().hello();
    EXPECT_EQ(hello.role(), v1::ROLE_DIRECTOR);
    EXPECT_EQ(hello.director(), "judge");
    EXPECT_EQ(hello.version().minor(), 5U);
    ASSERT_EQ(hello.subscription().groups_size(), 1);
    EXPECT_EQ(hello.subscription().groups(0), v1::Subscription::POSES);
    EXPECT_EQ(hello.subscription().entities(0), "a*");
    self.send(judge());
    self.send(arm_and_box());
    self.send(state(0, 2));
    const auto direction = self.receive().direction();
    EXPECT_EQ(direction.tick(), 0U);
    EXPECT_FALSE(direction.has_finish());
    ASSERT_EQ(direction.acts_size(), 6);
    EXPECT_EQ(direction.acts(0).move().entity(), "box");
    EXPECT_EQ(direction.acts(0).move().position(2), 3);
    EXPECT_EQ(direction.acts(0).move().orientation_size(), 0);
    EXPECT_EQ(direction.acts(1).spawn().xml(), "<box/>");
    EXPECT_EQ(direction.acts(2).remove().entity(), "arm");
    EXPECT_EQ(direction.acts(3).push().link(), "tip");
    EXPECT_EQ(direction.acts(3).push().force(1), 5);
    EXPECT_EQ(direction.acts(4).show().led_colors(1), 0x0102ffU);
    EXPECT_EQ(direction.acts(5).show().tag_payloads(0), "one");
    ASSERT_EQ(direction.metrics_size(), 1);
    EXPECT_EQ(direction.metrics(0).value(), 2) << "the last value counts";
    EXPECT_EQ(direction.log(0).text(), "hello");
    self.send(state(1, 2));
    const auto last = self.receive().direction();
    EXPECT_EQ(last.acts_size(), 0) << "what was sent is not sent again";
    EXPECT_EQ(last.finish().result(), "stands");
    self.end();
    EXPECT_EQ(self.receive().leave().reason(), v1::Leave::DONE);
  });
  DirectorOptions options = options_of(server);
  options.entities = {"a*"};
  Director director(options);
  EXPECT_EQ(director.id(), "judge");
  EXPECT_EQ(director.script(), "/judge.lua");
  EXPECT_EQ(director.params().at(0).second, "3");
  ASSERT_TRUE(director.next());
  EXPECT_EQ(director.event(), Event::init);
  ASSERT_EQ(director.entities().size(), 2U);
  const Entity& arm = director.entity("arm");
  EXPECT_EQ(arm.controller(), "swing");
  EXPECT_EQ(arm.kind(), "prototype");
  EXPECT_EQ(arm.pose().position[2], 2);
  EXPECT_EQ(arm.pose().orientation[0], 3);
  EXPECT_TRUE(arm.links().empty()) << "was not asked for";
  EXPECT_EQ(director.find("missing"), nullptr);
  EXPECT_THROW(director.entity("missing"), std::out_of_range);
  director.move("box", {1, 2, 3});
  director.spawn("<box/>");
  director.remove("arm");
  director.push("arm", {4, 5, 6}, {}, "tip");
  const std::array<Color, 2> colors{{{}, {1, 2, 255}}};
  director.set_leds("arm", colors);
  const std::array<std::string, 1> payloads{"one"};
  director.set_tags("arm", payloads);
  director.metric("height", 1);
  director.metric("height", 2);
  director.log("hello");
  EXPECT_THROW(director.metric("two words", 1), std::invalid_argument);
  EXPECT_THROW(director.push("arm", {std::numeric_limits<double>::quiet_NaN(), 0, 0}),
               std::invalid_argument);
  ASSERT_TRUE(director.next());
  EXPECT_EQ(director.event(), Event::step);
  EXPECT_EQ(director.time(), std::chrono::milliseconds(50));
  EXPECT_EQ(arm.pose().position[2], 102) << "the handle stays";
  director.finish("stands");
  EXPECT_FALSE(director.next());
  EXPECT_EQ(director.ending()->reason, Ending::Reason::finished);
}

TEST(Director, IsToldOfAllGroups) {
  FakeServer server([](FakeServer& self) {
    EXPECT_EQ(self.receive().hello().subscription().groups_size(), 8);
    self.send(judge());
    self.send(arm_and_box());
    self.send(full_state(0, -2));
    self.receive();
  });
  DirectorOptions options = options_of(server);
  options.groups.assign(options.all_groups.begin(), options.all_groups.end());
  Director director(options);
  ASSERT_TRUE(director.next());
  const Entity& arm = director.entity("arm");
  const Entity& box = director.entity("box");
  ASSERT_EQ(arm.links().size(), 2U);
  EXPECT_EQ(arm.link_ids()[1], "tip");
  EXPECT_EQ(arm.links()[1].position[0], 13);
  EXPECT_EQ(arm.links()[1].angular_velocity[2], 25);
  EXPECT_EQ(box.links()[0].velocity[0], 33);
  EXPECT_EQ(arm.joints()[0].velocity, -2);
  EXPECT_EQ(arm.leds()[1].blue, 255);
  EXPECT_TRUE(box.leds().empty());
  ASSERT_EQ(director.contacts().size(), 2U);
  const Contact& between = director.contacts()[0];
  EXPECT_EQ(between.first, &arm);
  EXPECT_EQ(between.first_link, 1U);
  EXPECT_EQ(between.second, &box);
  EXPECT_EQ(between.force[2], 8);
  EXPECT_TRUE(director.contacts()[1].is_with_floor);
  EXPECT_EQ(director.contacts()[1].second, nullptr);
  EXPECT_EQ(director.radio_messages()[0].receiver, &arm);
  EXPECT_EQ(director.radio_messages()[0].sender, nullptr);
  EXPECT_EQ(director.radio_messages()[0].payload[1], 'i');
}

TEST(Director, AnswersATickAgainWhoseAnswerWasWrong) {
  FakeServer server([](FakeServer& self) {
    self.welcome(judge());
    self.send(arm_and_box());
    self.send(state(0, 2));
    EXPECT_EQ(self.receive().direction().acts_size(), 1);
    self.discard(v1::Error::UNKNOWN_ENTITY);
    const auto again = self.receive().direction();
    EXPECT_EQ(again.tick(), 0U);
    EXPECT_EQ(again.acts(0).remove().entity(), "box");
    self.send(state(1, 2));
    self.receive();
  });
  Director director(options_of(server));
  ASSERT_TRUE(director.next());
  director.remove("bocks");
  EXPECT_THROW(director.next(), ProtocolError);
  director.remove("box");
  ASSERT_TRUE(director.next());
  EXPECT_EQ(director.tick(), 1U);
}

TEST(Director, MayLeaveAfterItHasFinishedTheRun) {
  FakeServer server([](FakeServer& self) {
    self.welcome(judge());
    self.send(arm_and_box());
    self.send(state(0, 2));
    EXPECT_EQ(self.receive().direction().finish().result(), "stands");
    EXPECT_EQ(self.receive().leave().reason(), v1::Leave::DONE);
  });
  Director director(options_of(server));
  ASSERT_TRUE(director.next());
  director.finish("stands");
  director.leave();
}

TEST(Director, EntitiesComeAndGo) {
  FakeServer server([](FakeServer& self) {
    self.welcome(judge());
    self.send(arm_and_box());
    self.send(state(0, 2));
    self.receive();
    v1::ServerMessage change;
    v1::WorldLayout& layout = *change.mutable_world_layout();
    layout.set_first(2);
    layout.add_removed(1);
    v1::EntityDescription& ball = *layout.add_entities();
    ball.set_id("ball");
    ball.set_kind("sphere");
    ball.add_links("");
    self.send(change);
    self.send(state(1, 3));
    self.receive();
    self.reset();
    self.send(arm_and_box());
    self.send(state(0, 2));
    self.receive();
  });
  Director director(options_of(server));
  ASSERT_TRUE(director.next());
  const Entity& box = director.entity("box");
  ASSERT_TRUE(director.next());
  EXPECT_TRUE(box.is_removed());
  EXPECT_EQ(director.find("box"), nullptr);
  ASSERT_EQ(director.entities().size(), 2U);
  EXPECT_EQ(director.entities()[1]->id(), "ball");
  EXPECT_EQ(director.entity("ball").pose().position[0], 114);
  ASSERT_TRUE(director.next());
  EXPECT_EQ(director.event(), Event::reset);
  EXPECT_EQ(director.seed(), 8U);
  EXPECT_EQ(director.find("ball"), nullptr);
  EXPECT_NE(director.find("box"), nullptr);
  EXPECT_TRUE(box.is_removed()) << "the handle of the world before";
  EXPECT_NE(director.find("box"), &box);
  EXPECT_TRUE(box.links().empty());
}

TEST(Director, AfterAResetSameEntitiesKeepTheirHandlesAndOthersWithTheirIdsAreNew) {
  FakeServer server([](FakeServer& self) {
    self.welcome(judge());
    self.send(arm_and_box());
    self.send(state(0, 2));
    self.receive();
    auto lit = arm_and_box();
    v1::EntityDescription& box = *lit.mutable_world_layout()->mutable_entities(1);
    box.set_kind("cylinder");
    box.add_leds();
    auto all = full_state(0, -2);
    all.mutable_world_state()->add_led_colors(0x00ff00);
    for (const auto& [layout, state] :
         {std::pair(arm_and_box(), full_state(0, -2)), std::pair(lit, all)}) {
      self.reset();
      self.send(layout);
      self.send(state);
      self.receive();
    }
  });
  Director director(options_of(server));
  ASSERT_TRUE(director.next());
  const Entity& box = director.entity("box");
  ASSERT_TRUE(director.next());
  EXPECT_EQ(director.find("box"), &box);
  EXPECT_FALSE(box.is_removed());
  ASSERT_TRUE(director.next());
  EXPECT_TRUE(box.is_removed());
  EXPECT_EQ(director.entity("box").kind(), "cylinder");
  ASSERT_EQ(director.entity("box").leds().size(), 1U);
  EXPECT_EQ(director.entity("box").leds()[0].green, 255);
}

TEST(Director, AStateThatWasNotAnnouncedIsRefused) {
  FakeServer server([](FakeServer& self) {
    self.welcome(judge());
    self.send(arm_and_box());
    self.send(state(0, 3));
  });
  Director director(options_of(server));
  EXPECT_THROW(director.next(), ConnectionError);
}

/// @param links  without id, of a body each
v1::ServerMessage laid_out(std::uint32_t first, int entities, int links) {
  v1::ServerMessage message;
  message.mutable_world_layout()->set_first(first);
  for (int i = 0; i < entities; ++i) {
    v1::EntityDescription& entity = *message.mutable_world_layout()->add_entities();
    entity.set_id("b" + std::to_string(i));
    entity.set_kind("box");
    for (int l = 0; l < links; ++l) entity.add_links("");
  }
  return message;
}

TEST(Director, IsToldOfAMillionBoxes) {
  constexpr int count = long_runs::is_slow ? 100'000 : 1'000'000;
  FakeServer server([](FakeServer& self) {
    self.welcome(judge());
    self.send(laid_out(0, count, 1));
    self.send(state(0, count));
    self.receive();
  });
  Director director(options_of(server));
  ASSERT_TRUE(director.next());
  EXPECT_EQ(director.entities().size(), std::size_t{count});
}

TEST(Director, ResumesAndSendsTheAnswerAgain) {
  FakeServer server([](FakeServer& self) {
    self.welcome(judge());
    self.send(arm_and_box());
    self.send(state(3, 2));
    EXPECT_EQ(self.receive().direction().acts_size(), 1);
    self.cut();
    EXPECT_EQ(self.receive().hello().session_token(), "token");
    self.send(judge());
    self.send(arm_and_box());
    self.send(state(3, 2));
    const auto again = self.receive().direction();
    EXPECT_EQ(again.tick(), 3U);
    ASSERT_EQ(again.acts_size(), 1);
    EXPECT_EQ(again.acts(0).remove().entity(), "box");
    self.send(state(4, 2));
    EXPECT_EQ(self.receive().direction().acts_size(), 0);
    self.finish();
  });
  Director director(options_of(server));
  ASSERT_TRUE(director.next());
  const Entity& box = director.entity("box");
  director.remove("box");
  ASSERT_TRUE(director.next());
  EXPECT_EQ(director.tick(), 4U) << "no tick is seen twice";
  EXPECT_EQ(director.resumes(), 1U);
  EXPECT_EQ(&director.entity("box"), &box);
  EXPECT_FALSE(director.next());
}

TEST(Director, WhatItDoesAtATickIsBounded) {
  FakeServer server([](FakeServer& self) {
    self.welcome(judge());
    self.send(arm_and_box());
    self.send(state(0, 2));
    EXPECT_EQ(self.receive().direction().acts_size(), 10'000);
  });
  DirectorOptions options = options_of(server);
  options.resume_timeout = std::chrono::milliseconds{0};
  Director director(options);
  ASSERT_TRUE(director.next());
  const std::string long_text(std::size_t{4} << 20, 'x');
  EXPECT_THROW(director.spawn(long_text), std::length_error);
  EXPECT_THROW(director.finish(long_text), std::length_error);
  EXPECT_THROW(director.log(long_text), std::length_error);
  for (int i = 0; i < 10'000; ++i) director.remove("box");
  EXPECT_THROW(director.remove("box"), std::length_error);
  for (int i = 0; i < 100; ++i) director.metric("m" + std::to_string(i), i);
  EXPECT_THROW(director.metric("one-more", 1), std::length_error);
  EXPECT_THROW(director.next(), ConnectionError);  // the server is gone
}

}  // namespace
}  // namespace ziggurat
