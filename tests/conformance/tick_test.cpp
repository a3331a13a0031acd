// The rules of section 3 of docs/protocol.md, the tick. A test is named after its rule.

#include <gtest/gtest.h>

#include <limits>

#include "rules.h"

namespace ziggurat::network {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

TEST_F(Stepping, S2_ReadingsArePackedInWelcomesOrder) {
  peers.publish(6);
  const auto observation = peers.told("p").observation();
  EXPECT_EQ(observation.tick(), 6U);
  EXPECT_EQ(observation.time_ns(), 600'000'000);
  EXPECT_EQ(
      std::vector<double>(observation.joint_readings().begin(), observation.joint_readings().end()),
      (std::vector<double>{600, 601, 603}));
}

TEST_F(Stepping, S3_OnlyTheCommandReleasesTheTick) {
  EXPECT_FALSE(peers.is_complete());
  peers.say("p", Peers::heartbeat(1));
  EXPECT_FALSE(peers.is_complete());
  peers.say("p", Peers::leave({1}));
  EXPECT_FALSE(peers.is_complete());
  peers.say("p", Peers::command(5));
  EXPECT_TRUE(peers.is_complete());
}

TEST_F(Stepping, S5_TargetsStayUntilChanged) {
  peers.say("p", Peers::command(5, {1, 2, 4}));
  peers.publish(6);
  peers.say("p", Peers::command(6));
  EXPECT_EQ(peers.commands.joint_targets, (std::vector<double>{1, 2, 0, 4}));
}

TEST_F(Stepping, S6_SomeRobotsInAnyOrder) {
  auto command = Peers::command(5, {40, 10});
  command.mutable_command()->add_robots(2);
  command.mutable_command()->add_robots(0);
  peers.say("p", command);
  EXPECT_EQ(peers.commands.joint_targets, (std::vector<double>{10, 0, 0, 40}));
}

TEST_F(Stepping, S6_AnotherLengthIsABadValue) {
  for (const auto& targets : {std::vector<double>{1, 2}, std::vector<double>{1, 2, 3, 4}}) {
    const auto error = faulted(peers, Peers::command(5, targets));
    EXPECT_EQ(error.code(), v1::Error::BAD_VALUE);
    EXPECT_EQ(error.field(), "joint_targets");
    EXPECT_EQ(error.tick(), 5U);
  }
}

TEST_F(Stepping, S6_ValuesOfRobotsThatLeftAreIgnored) {
  peers.say("p", Peers::leave({1}));
  peers.say("p", Peers::command(5, {1, 2, 4}));
  EXPECT_EQ(peers.commands.joint_targets, (std::vector<double>{1, 0, 0, 4}));
}

TEST_F(Stepping, S7_Positions) {
  auto command = Peers::command(5);
  command.mutable_command()->add_robots(3);
  auto error = faulted(peers, command);
  EXPECT_EQ(error.code(), v1::Error::UNKNOWN_ROBOT);
  EXPECT_EQ(error.field(), "robots");
  command.mutable_command()->set_robots(0, 4'294'967'295U);
  EXPECT_EQ(faulted(peers, command).code(), v1::Error::UNKNOWN_ROBOT);
  command.mutable_command()->set_robots(0, 1);
  command.mutable_command()->add_robots(1);
  EXPECT_EQ(faulted(peers, command).code(), v1::Error::BAD_VALUE);
  peers.say("p", Peers::leave({1}));
  error = faulted(peers, command);
  EXPECT_EQ(error.code(), v1::Error::NOT_YOURS);
  EXPECT_EQ(error.robot(), "robot1");
}

TEST_F(Stepping, S8_NumbersAreFinite) {
  for (const double bad : {nan, infinity, -infinity}) {
    const auto error = faulted(peers, Peers::command(5, {1, 2, bad}));
    EXPECT_EQ(error.code(), v1::Error::BAD_VALUE);
    EXPECT_EQ(error.robot(), "robot3");
    EXPECT_NE(error.message().find("'hinge'"), std::string::npos);
  }
}

TEST_F(Stepping, S9_Ticks) {
  EXPECT_EQ(faulted(peers, Peers::command(4, {1, 2, 3})).code(), v1::Error::STALE_TICK);
  EXPECT_EQ(faulted(peers, Peers::command(6, {1, 2, 3})).code(), v1::Error::FUTURE_TICK);
  peers.say("p", Peers::command(5, {1, 2, 3}));
  EXPECT_EQ(faulted(peers, Peers::command(5, {7, 7, 7})).code(), v1::Error::DUPLICATE_TICK);
}

TEST_F(Stepping, S10_ABadCommandHasNoEffectAndARightOneMayFollow) {
  auto command = Peers::command(5, {1, 2, 3});
  auto& line = *command.mutable_command()->add_log();
  line.set_robot(3);  // the only fault, in the last field
  line.set_text("x");
  EXPECT_EQ(faulted(peers, command).code(), v1::Error::UNKNOWN_ROBOT);
  EXPECT_FALSE(peers.is_complete());
  line.set_robot(2);
  peers.say("p", command);
  EXPECT_TRUE(peers.is_complete());
  EXPECT_EQ(peers.commands.joint_targets, (std::vector<double>{1, 2, 0, 3}));
  const auto log = peers.take_report().log;
  ASSERT_EQ(log.size(), 1U);
  EXPECT_EQ(log[0].robot, 3U);
}

TEST_F(Stepping, S11_LinesComeInSceneOrder) {
  peers.say("p", Peers::command(5));
  peers.publish(6);
  const auto answer = [&](const std::string& peer, std::vector<std::uint32_t> robots) {
    auto command = Peers::command(6);
    int count = 0;
    for (const auto robot : robots) {
      auto& line = *command.mutable_command()->add_log();
      line.set_robot(robot);
      line.set_text(std::to_string(count++));
    }
    peers.say(peer, command);
  };
  answer("p", {2, 0, 2, 1});
  answer("q", {0});
  std::string text;
  for (const auto& line : peers.take_report().log) {
    text += std::to_string(line.robot) + ":" + line.text + " ";
  }
  EXPECT_EQ(text, "0:1 1:3 2:0 3:0 3:2 ");
}

}  // namespace
}  // namespace ziggurat::network
