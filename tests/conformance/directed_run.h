// SPDX-License-Identifier: MIT
#pragma once
// A run with two robots and two directors, for the rules of section 9.1.

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "network/barrier/directing.h"
#include "rules.h"

namespace ziggurat::network {

using Ids = std::vector<std::string>;

/// Boxes b0, b1, …: box i is at x = i, and has one LED.
struct Boxes {
  explicit Boxes(std::size_t count) {
    while (layout.entities.size() < count) add();
  }
  void add() {
    const std::size_t i = layout.entities.size();
    layout.entities.push_back({"b" + std::to_string(i), {i, 1}, false, {i, 1}});
    layout.links.push_back({"", i});
    world::LedLayout& led = layout.leds.emplace_back();
    led.id = "led";
    led.mount.entity = i;
    led.color = 7;
    entities.emplace_back().kind = scene::EntityKind::box;
    state.origins.push_back({{static_cast<double>(i), 0, 0}, math::Quaternion::Identity()});
    state.links.emplace_back().pose = state.origins.back();
    state.led_colors.push_back(static_cast<world::Color>(i));
    state.absent.push_back(false);
  }
  wire::Truth truth() const { return {layout, entities, state, observations, contacts}; }

  world::Layout layout;
  std::vector<scene::Entity> entities;
  world::State state;
  world::Observations observations;
  std::vector<world::Contact> contacts;
};

inline v1::ClientMessage director(const std::string& id) {
  auto message = Peers::hello("");
  v1::Hello& hello = *message.mutable_hello();
  hello.clear_robots();
  hello.mutable_version()->set_minor(4);
  hello.set_role(v1::ROLE_DIRECTOR);
  hello.set_director(id);
  hello.mutable_subscription()->add_groups(v1::Subscription::POSES);
  return message;
}

inline v1::ClientMessage direction(std::uint64_t tick) {
  v1::ClientMessage message;
  message.mutable_direction()->set_tick(tick);
  return message;
}

inline v1::ClientMessage pushes(std::uint64_t tick, std::vector<double> force) {
  auto message = direction(tick);
  v1::Push& push = *message.mutable_direction()->add_acts()->mutable_push();
  push.set_entity("b0");
  push.mutable_force()->Add(force.begin(), force.end());
  return message;
}

/// Two robots that "c" has, and the directors `judge` and, with a deadline of 50 ms, `hasty`.
struct Directing : ::testing::Test {
  explicit Directing(const Config& config = {})
      : small(make_run()), peers(small, config), boxes(2) {
    peers.say("c", Peers::hello("*"));
    peers.inboxes.clear();
  }
  static SmallRun make_run() {
    SmallRun run(2);
    run.directors.emplace_back().id = "judge";
    run.directors.back().params = {{"height", "0.3"}};
    run.directors.back().script = "/scenes/judge.lua";
    run.directors.emplace_back().id = "hasty";
    run.directors.back().deadline = {scene::DeadlineAction::hold, 50, 2};
    return run;
  }
  /// Both directors are there; tick 5 is published, and "c" has answered it.
  void begin() {
    peers.say("p", director("judge"));
    peers.say("q", director("hasty"));
    publish(5);
    peers.say("c", Peers::command(5));
    peers.inboxes.clear();
  }
  void publish(std::uint64_t tick) {
    boxes.state.tick = tick;
    peers.observations = small.observations(tick);
    const wire::Truth truth = boxes.truth();
    network::publish(peers.barrier, peers.observations, peers.payloads, &truth);
  }
  /// Messages to "p" since the last call.
  std::vector<v1::ServerMessage> told() { return std::exchange(peers.inboxes["p"], {}); }
  Ids answered() {
    Ids ids;
    for (const Directed& each : directions(peers.barrier)) ids.push_back(each.director);
    return ids;
  }

  SmallRun small;
  Peers peers;
  Boxes boxes;
};

}  // namespace ziggurat::network
