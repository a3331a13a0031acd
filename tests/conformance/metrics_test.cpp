// SPDX-License-Identifier: MIT
// Metrics that are kept (docs/protocol.md: S14).

#include <gtest/gtest.h>

#include "rules.h"

namespace ziggurat::network {
namespace {

v1::ClientMessage measured(std::uint64_t tick, std::uint32_t robot, const std::string& name,
                           double value) {
  auto message = Peers::command(tick);
  v1::Metric& metric = *message.mutable_command()->add_metrics();
  metric.set_robot(robot);
  metric.set_name(name);
  metric.set_value(value);
  return message;
}

/// "p" holds robot1 and robot2 of three, and owes tick 5.
struct Measuring : ::testing::Test {
  Measuring() : small(3), peers(small) {
    auto hello = Peers::hello("robot[12]");
    hello.mutable_hello()->mutable_version()->set_minor(3);
    peers.say("p", hello);
    peers.publish(5);
    peers.inboxes.clear();
  }
  std::vector<std::string> last() const { return keys(peers.barrier.metrics.last()); }
  std::vector<std::string> of_tick() const { return keys(peers.barrier.metrics.of_tick()); }
  std::vector<std::string> keys(const std::vector<wire::Metric>& metrics) const {
    std::vector<std::string> result;
    for (const auto& one : named(peers.barrier, metrics)) {
      result.push_back(world::key_of(one) + "=" + std::to_string(static_cast<int>(one.value)));
    }
    return result;
  }
  SmallRun small;
  Peers peers;
};

using Texts = std::vector<std::string>;

TEST_F(Measuring, S14_MetricsAreThoseOfTheirTickAndTheLastOnesStay) {
  peers.say("p", measured(5, 1, "blocks", 3));
  EXPECT_EQ(of_tick(), (Texts{"robot2/blocks=3"}));
  peers.publish(6);
  peers.say("p", measured(6, 0, "a.b-c_9", 4));
  EXPECT_EQ(of_tick(), (Texts{"robot1/a.b-c_9=4"}));
  EXPECT_EQ(last(), (Texts{"robot1/a.b-c_9=4", "robot2/blocks=3"}));
}

TEST_F(Measuring, S14_TheLastOfTwoValuesCounts) {
  auto command = measured(5, 0, "x", 1);
  *command.mutable_command()->add_metrics() = measured(5, 0, "x", 2).command().metrics(0);
  peers.say("p", command);
  EXPECT_EQ(last(), (Texts{"robot1/x=2"}));
}

TEST_F(Measuring, S14_ALeaveMayHaveTheLastOnes) {
  auto leave = Peers::leave();
  *leave.mutable_leave()->add_metrics() = measured(5, 1, "total", 8).command().metrics(0);
  peers.say("p", leave);
  EXPECT_EQ(last(), (Texts{"robot2/total=8"}));
}

TEST_F(Measuring, S14_AResetForgetsThem) {
  peers.say("p", measured(5, 0, "x", 1));
  restart(peers.barrier, {.seed = 1});
  EXPECT_EQ(last(), Texts{});
}

}  // namespace
}  // namespace ziggurat::network
