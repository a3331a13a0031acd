// SPDX-License-Identifier: MIT
#pragma once
// Two controllers under a deadline policy.

#include "network/peers.h"

namespace ziggurat::network {

/// All controllers have this policy, and no Hello may change it.
inline Config with_deadline(scene::DeadlineAction action, std::uint32_t ms,
                            std::uint32_t budget = 0) {
  Config config;
  config.deadlines.assign(2, {{action, ms, budget}, true});
  config.heartbeat = std::chrono::milliseconds{100'000};  // out of the way
  return config;
}

inline v1::ClientMessage wish(const std::string& robots, v1::DeadlinePolicy::Action action,
                              std::uint32_t ms, std::uint32_t budget = 0) {
  auto hello = Peers::hello(robots);
  auto& policy = *hello.mutable_hello()->mutable_deadline_policy();
  policy.set_action(action);
  policy.set_wall_deadline_ms(ms);
  policy.set_miss_budget(budget);
  return hello;
}

/// "p" holds robot0 and owes tick 5, having commanded 3 before; "q" holds robot1 and has answered.
struct Pair {
  explicit Pair(const Config& config) : small(2), peers(small, config) {
    peers.join("p", "robot0");
    peers.join("q", "robot1");
    tick(4, {3});
    peers.publish(5);
    peers.say("q", Peers::command(5, {7}));
    peers.inboxes.clear();
  }
  void tick(std::uint64_t number, std::vector<double> targets = {}) {
    peers.publish(number);
    peers.say("p", Peers::command(number, std::move(targets)));
    peers.say("q", Peers::command(number));
  }
  double target() {
    zero_missing(peers.barrier, peers.commands);
    return peers.commands.joint_targets[0];
  }
  /// "p" is silent at the current tick, and a new one begins for both.
  void miss_and_go_on(std::uint64_t next) {
    peers.pass(std::chrono::milliseconds{50});
    EXPECT_TRUE(peers.is_complete()) << next;
    peers.publish(next);
    peers.say("q", Peers::command(next));
  }
  SmallRun small;
  Peers peers;
};

}  // namespace ziggurat::network
