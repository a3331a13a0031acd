// SPDX-License-Identifier: MIT
// Changes of the world between two ticks, while clients connect and leave.

#include <gtest/gtest.h>

#include <thread>

#include "network/local_server.h"
#include "network/one_peer.h"
#include "network/small_run.h"
#include "waiting.h"

namespace ziggurat::network {
namespace {

using std::chrono::milliseconds;

v1::ClientMessage hello(v1::Role role) {
  v1::ClientMessage message;
  message.mutable_hello()->mutable_version()->set_major(1);
  message.mutable_hello()->mutable_version()->set_minor(4);
  message.mutable_hello()->set_role(role);
  return message;
}

void take_all_robots(Server& server, Peer& client) {
  auto wish = hello(v1::ROLE_CONTROLLER);
  wish.mutable_hello()->add_robots("*");
  client.say(wish);
  ASSERT_EQ(server.gather(patience), Outcome::complete);
}

/// On a path: there the end of a connection is found out at once.
Config path_config() {
  Config config;
  config.endpoints = {"ipc://*"};
  return config;
}

TEST(BetweenTicks, ASessionOfRobotsThatAResetHasTakenAwayIsOverWithoutThem) {
  SmallRun small(2);
  Config config = path_config();
  config.heartbeat = milliseconds{1};
  Server server(config, small.run());
  world::Commands commands = small.commands();
  {
    Peer client(server.endpoints());
    take_all_robots(server, client);
    const world::Observations seen = small.observations(0);
    server.publish(seen, no_tags);
    v1::ClientMessage answer;
    answer.mutable_command();
    client.say(answer);
    ASSERT_EQ(server.collect(commands, patience), Outcome::complete);
  }
  std::this_thread::sleep_for(
      milliseconds{200});  // longer than between heartbeats; the client is gone
  server.take_report();
  small.layout().robots.resize(1);
  server.restart({42});
  for (const std::string& notice : server.take_report().notices) {
    EXPECT_EQ(notice.find("is lost"), std::string::npos) << notice;
  }
  ASSERT_EQ(server.status().size(), 1U);
  EXPECT_EQ(server.status()[0].membership, RobotStatus::Membership::free);
}

TEST(BetweenTicks, AWorldThatIsBeingPutBackSendsHeartbeatsAndLooksAtNoRobots) {
  SmallRun small(2);
  Config config = path_config();
  config.heartbeat = milliseconds{1};
  Server server(config, small.run());
  world::Commands commands = small.commands();
  Peer observer(server.endpoints());
  observer.say(hello(v1::ROLE_OBSERVER));
  {
    Peer client(server.endpoints());
    take_all_robots(server, client);
    server.linger(commands, {milliseconds{200}, {}});
  }
  ASSERT_TRUE(observer.hear().has_welcome());
  std::this_thread::sleep_for(milliseconds{200});  // the controller is gone
  server.take_report();
  small.layout().robots.resize(1);  // as in a world that is half built
  const auto heartbeat = [&] {
    keep_alive(server);
    return observer.hear().heartbeat().sequence();
  };
  const std::uint64_t first = heartbeat();
  std::this_thread::sleep_for(milliseconds{20});  // longer than between heartbeats
  keep_alive(server);
  for (std::uint64_t heard = first; heard <= first + 1;) heard = heartbeat();
  EXPECT_TRUE(server.take_report().notices.empty()) << "the controller is told of later";
}

TEST(BetweenTicks, WhatDirectorsWantStaysWhileRobotsAreSpawned) {
  SmallRun small(0);
  Config config = path_config();
  config.allows_directors = true;
  Server server(config, small.run());
  ServerDirectors directors(server);
  world::Commands commands = small.commands();
  const world::Layout layout;
  const std::vector<scene::Entity> entities;
  const world::State state;
  const std::vector<world::Contact> contacts;
  const world::Observations seen = small.observations(0);
  const wire::Truth truth{layout, entities, state, seen, contacts};
  {
    Peer client(server.endpoints());
    auto wish = hello(v1::ROLE_DIRECTOR);
    wish.mutable_hello()->set_director("judge");
    wish.mutable_hello()->mutable_deadline_policy()->set_action(v1::DeadlinePolicy::HOLD);
    wish.mutable_hello()->mutable_deadline_policy()->set_wall_deadline_ms(1000);
    client.say(wish);
    while (!directors.has("judge"))
      ASSERT_NE(server.gather({milliseconds{20}, {}}), Outcome::woken);
    server.publish(seen, no_tags, &truth);
    v1::ClientMessage answer;
    answer.mutable_direction()->add_acts()->mutable_remove()->set_entity("box");
    client.say(answer);
    ASSERT_EQ(server.collect(commands, patience), Outcome::complete);
  }
  ASSERT_EQ(directors.directions().size(), 1U);
  ASSERT_TRUE(comes_true([&] {
    directors.warn("judge", {});
    return !directors.status()[0].is_held;
  }));
  std::this_thread::sleep_for(milliseconds{1100});  // its deadline as one that is gone
  small.add_robot();
  const world::Observations theirs = small.observations(0);
  const std::string script;
  server.add_robots({&script, 1}, theirs, no_tags);
  EXPECT_EQ(directors.directions().size(), 1U) << "they are being done";
}

}  // namespace
}  // namespace ziggurat::network
