// Metrics, which version 1.3 of the protocol adds (docs/protocol.md: S14).

#include <gtest/gtest.h>

#include <limits>

#include "rules.h"

namespace ziggurat::network {
namespace {

v1::ClientMessage measured(std::uint64_t tick, std::uint32_t robot, const std::string& name, double value) {
  auto message = Peers::command(tick);
  v1::Metric& metric = *message.mutable_command()->add_metrics();
  metric.set_robot(robot);
  metric.set_name(name);
  metric.set_value(value);
  return message;
}

/// "p" holds robot1 and robot2 of three, and owes tick 5.
struct Measuring : ::testing::Test {
  explicit Measuring(std::uint32_t minor = 3) : small(3), peers(small) {
    auto hello = Peers::hello("robot[12]");
    hello.mutable_hello()->mutable_version()->set_minor(minor);
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

struct MeasuringWithoutThem : Measuring {
  MeasuringWithoutThem() : Measuring(2) {}
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

TEST_F(Measuring, S14_NamesAreShortAndPlain) {
  const Texts wrong{"", std::string(65, 'x'), "a b", "a/b", "\u00e9", "a\n"};
  for (const std::string& name : wrong) {
    EXPECT_EQ(faulted(peers, measured(5, 0, name, 1)).code(), v1::Error::BAD_VALUE) << name;
  }
  EXPECT_EQ(last(), Texts{});
  peers.say("p", measured(5, 0, std::string(64, 'x'), 1));
  EXPECT_TRUE(peers.told("p").message_case() == v1::ServerMessage::MESSAGE_NOT_SET);
}

TEST_F(Measuring, S14_ValuesAreFinite) {
  for (const double value : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(faulted(peers, measured(5, 0, "x", value)).code(), v1::Error::BAD_VALUE);
  }
}

TEST_F(Measuring, S14_ARobotOfAnotherSessionIsUnknown) {
  EXPECT_EQ(faulted(peers, measured(5, 2, "x", 1)).code(), v1::Error::UNKNOWN_ROBOT);
}

TEST_F(Measuring, S14_ARobotHas100NamesAtMost) {
  auto command = Peers::command(5);
  const auto add = [&](std::uint32_t robot, int number) {
    v1::Metric& metric = *command.mutable_command()->add_metrics();
    metric.set_robot(robot);
    metric.set_name("m" + std::to_string(number));
  };
  for (int i = 0; i < 101; ++i) add(0, i);
  EXPECT_EQ(faulted(peers, command).code(), v1::Error::TOO_MANY);
  EXPECT_EQ(last(), Texts{});
  command.mutable_command()->mutable_metrics()->RemoveLast();
  for (int i = 0; i < 100; ++i) add(1, i);
  peers.say("p", command);
  EXPECT_EQ(last().size(), 200U);
  peers.publish(6);
  peers.inboxes.clear();
  EXPECT_EQ(faulted(peers, measured(6, 0, "one_more", 1)).code(), v1::Error::TOO_MANY);
  peers.say("p", measured(6, 0, "m7", 1));
  EXPECT_EQ(of_tick(), (Texts{"robot1/m7=1"}));
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

TEST_F(MeasuringWithoutThem, S14_SessionsOfEarlierVersionsHaveNone) {
  peers.say("p", measured(5, 7, "a name that would be wrong", 1));
  EXPECT_EQ(peers.told("p").message_case(), v1::ServerMessage::MESSAGE_NOT_SET);
  EXPECT_EQ(last(), Texts{});
}

}  // namespace
}  // namespace ziggurat::network
