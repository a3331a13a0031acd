// The rules of section 2 of docs/protocol.md, beginning a session. A test is named after its rule.

#include <gtest/gtest.h>

#include "rules.h"

namespace ziggurat::network {
namespace {

TEST(Hello, H2_AnotherMajorVersionIsRefusedWithBoth) {
  const SmallRun small(1);
  Peers peers(small);
  auto hello = Peers::hello("*");
  hello.mutable_hello()->mutable_version()->set_major(2);
  peers.say("p", hello);
  const auto refusal = peers.told("p").refusal();
  EXPECT_EQ(refusal.error().code(), v1::Error::VERSION_MISMATCH);
  EXPECT_EQ(refusal.server_version().major(), 1U);
  EXPECT_EQ(refusal.client_version().major(), 2U);
  EXPECT_NE(refusal.error().message().find("2.0"), std::string::npos);
}

TEST(Hello, H2_AHelloWithoutVersionIsToldThat) {
  const SmallRun small(1);
  Peers peers(small);
  auto hello = Peers::hello("*");
  hello.mutable_hello()->clear_version();
  peers.say("p", hello);
  const auto refusal = peers.told("p").refusal();
  EXPECT_EQ(refusal.error().code(), v1::Error::VERSION_MISMATCH);
  EXPECT_EQ(refusal.error().message(),
            "The Hello has no major version of the protocol; write the one of the client, as 1.4, the server's.");
}

TEST(Hello, H2_TheLowerMinorVersionCounts) {
  const SmallRun small(1);
  Peers peers(small);
  auto hello = Peers::hello("*");
  hello.mutable_hello()->mutable_version()->set_minor(7);
  peers.say("p", hello);
  EXPECT_EQ(peers.told("p").welcome().version().minor(), wire::version.minor);
}

TEST(Hello, H16_NamesAreCutAndPrintable) {
  const SmallRun small(1);
  Peers peers(small);
  auto hello = Peers::hello("*");
  hello.mutable_hello()->set_client_name("\x1b]" + std::string(100, 'x'));
  hello.mutable_hello()->set_client_version(std::string(100, '1'));
  peers.say("q", hello);
  peers.say("p", Peers::hello("*"));
  EXPECT_EQ(peers.told("p").refusal().holder(),
            "?]" + std::string(62, 'x') + " " + std::string(64, '1'));
}

TEST(Hello, H3_Roles) {
  const SmallRun small(1);
  Peers peers(small);
  auto hello = Peers::hello("*");
  hello.mutable_hello()->set_role(v1::ROLE_SUPERVISOR);
  EXPECT_EQ(refused(peers, hello).code(), v1::Error::BAD_VALUE) << "it asks for robots";
  hello.mutable_hello()->set_role(v1::ROLE_UNSPECIFIED);
  EXPECT_EQ(refused(peers, hello).code(), v1::Error::BAD_VALUE);
  hello.mutable_hello()->set_role(static_cast<v1::Role>(-7));
  EXPECT_EQ(refused(peers, hello).code(), v1::Error::BAD_VALUE);
}

TEST(Hello, H4_CriteriaAreJoinedByAnd) {
  const SmallRun small(6);  // even ones are driven by scripts
  Peers peers(small);
  auto hello = Peers::hello("robot[0-3]");
  hello.mutable_hello()->set_lua_only(true);
  peers.say("r", hello);
  const auto welcome = peers.told("r").welcome();
  ASSERT_EQ(welcome.robots_size(), 2);
  EXPECT_EQ(welcome.robots(0).id(), "robot0");
  EXPECT_EQ(welcome.robots(1).id(), "robot2");
  hello = Peers::hello("*");
  hello.mutable_hello()->clear_robots();
  EXPECT_EQ(refused(peers, hello).code(), v1::Error::BAD_VALUE);
  hello.mutable_hello()->set_controller("external");
  peers.say("q", hello);
  EXPECT_EQ(peers.told("q").welcome().robots_size(), 3);
  EXPECT_FALSE(peers.is_gathered());
  peers.join("s", "robot4");
  EXPECT_TRUE(peers.is_gathered());
}

TEST(Hello, H4_AllOrNothing) {
  const SmallRun small(3);
  Peers peers(small);
  peers.join("q", "robot1");
  EXPECT_EQ(refused(peers, Peers::hello("*")).code(), v1::Error::ROBOT_TAKEN);
  EXPECT_EQ(peers.status()[0].membership, RobotStatus::Membership::free);
}

TEST(Hello, H5_UnknownNames) {
  const SmallRun small(1);
  Peers peers(small);
  EXPECT_EQ(refused(peers, Peers::hello("robot7")).code(), v1::Error::UNKNOWN_ROBOT);
  EXPECT_EQ(refused(peers, Peers::hello("x*")).code(), v1::Error::UNKNOWN_ROBOT);
  auto hello = Peers::hello("*");
  hello.mutable_hello()->set_controller("nobody");
  EXPECT_EQ(refused(peers, hello).code(), v1::Error::UNKNOWN_CONTROLLER);
}

TEST(Hello, H6_TheHolderIsNamedAndNotDisturbed) {
  const SmallRun small(1);
  Peers peers(small);
  peers.join("q", "*");
  peers.say("p", Peers::hello("robot0"));
  const auto refusal = peers.told("p").refusal();
  EXPECT_EQ(refusal.error().code(), v1::Error::ROBOT_TAKEN);
  EXPECT_EQ(refusal.error().robot(), "robot0");
  EXPECT_TRUE(refusal.error().retryable());
  EXPECT_EQ(refusal.holder(), "tester");
  EXPECT_EQ(peers.status()[0].holder, "tester");
}

TEST(Hello, H7_RobotsThatLeftStayGone) {
  const SmallRun small(2);
  Peers peers(small);
  peers.join("q", "robot0");
  peers.say("q", Peers::leave());
  EXPECT_EQ(refused(peers, Peers::hello("robot0")).code(), v1::Error::NOT_YOURS);
  EXPECT_EQ(peers.join("p", "*").robots_size(), 1);
}

TEST(Hello, H9_WelcomeDescribesRunAndRobots) {
  const SmallRun small(2);
  Peers peers(small);
  const auto welcome = peers.join("p", "*");
  EXPECT_EQ(welcome.tick_ns(), 100'000'000U);
  EXPECT_EQ(welcome.ticks_per_second(), 10U);
  EXPECT_EQ(welcome.seed(), 42U);
  EXPECT_EQ(welcome.scene_hash(), "0123456789abcdef");
  EXPECT_EQ(welcome.mode(), v1::MODE_LOCK_STEP);
  ASSERT_EQ(welcome.robots_size(), 2);
  const auto& robot = welcome.robots(0);
  EXPECT_EQ(robot.controller(), "lua");
  EXPECT_EQ(robot.script(), "/scenes/drive.lua");
  ASSERT_EQ(robot.params_size(), 2);
  EXPECT_EQ(robot.params(0).name(), "speed");
  EXPECT_EQ(robot.params(0).value(), "0");
  ASSERT_EQ(robot.joint_sensors_size(), 1);
  EXPECT_EQ(robot.joint_sensors(0).mode(), v1::JointDescription::POSITION);
  ASSERT_EQ(robot.joint_actuators_size(), 1);
  EXPECT_EQ(robot.joint_actuators(0).mode(), v1::JointDescription::VELOCITY);
  EXPECT_EQ(robot.joint_actuators(0).max_impulse(), 0.005);
  EXPECT_EQ(welcome.robots(1).script(), "");
}

TEST(Hello, H9_AWelcomeThatClientsDoNotDecodeIsTooLarge) {
  SmallRun small(4);
  const std::string long_value(std::size_t{16} << 20, 'x');  // 1 048 576 fields
  small.layout().robots[1].params.emplace_back("route", long_value);
  small.layout().robots[3].params.emplace_back("route", long_value);
  Peers peers(small);
  peers.join("q", "robot1");
  auto hello = takeover("*");
  const v1::Error error = refused(peers, hello);
  EXPECT_EQ(error.code(), v1::Error::TOO_LARGE);
  EXPECT_EQ(error.field(), "robots");
  EXPECT_FALSE(error.retryable());
  EXPECT_TRUE(peers.inboxes["q"].empty()) << "the holder of a robot is not disturbed";
  EXPECT_EQ(peers.join("p", "robot[023]").robots_size(), 3) << "half of it is decoded";
}

TEST(Hello, H9_AWelcomeOfADirectorIsBoundedToo) {
  SmallRun small(1);
  small.directors.emplace_back().id = "judge";
  small.directors[0].params.emplace_back("map", std::string(std::size_t{33} << 20, 'x'));
  Peers peers(small);
  auto hello = Peers::hello("");
  hello.mutable_hello()->clear_robots();
  hello.mutable_hello()->mutable_version()->set_minor(4);
  hello.mutable_hello()->set_role(v1::ROLE_DIRECTOR);
  hello.mutable_hello()->set_director("judge");
  EXPECT_EQ(refused(peers, hello).code(), v1::Error::TOO_LARGE);
}

TEST(Hello, H11_ALateSessionGetsTheTickThatTheOthersAreAt) {
  const SmallRun small(2);
  Peers peers(small);
  peers.join("q", "*");
  peers.publish(8);
  peers.unreachable.insert("q");
  peers.probe();
  peers.say("p", Peers::hello("robot1"));
  ASSERT_EQ(peers.inboxes["p"].size(), 2U);
  EXPECT_EQ(peers.inboxes["p"][1].observation().tick(), 8U);
  EXPECT_EQ(peers.inboxes["p"][1].observation().joint_readings(0), 801);
}

TEST(Hello, TooManySessions) {
  const SmallRun small(2);
  Config config;
  config.max_sessions = 1;
  Peers peers(small, config);
  peers.join("q", "robot0");
  const auto error = refused(peers, Peers::hello("robot1"));
  EXPECT_EQ(error.code(), v1::Error::TOO_MANY);
  EXPECT_TRUE(error.retryable());
}

TEST(Hello, V2_ARequestOfASessionThatHasLeftIsNotAnsweredToTheNextOne) {
  const SmallRun small(1);
  Peers peers(small);
  v1::ClientMessage supervisor = Peers::hello("");
  supervisor.mutable_hello()->clear_robots();
  supervisor.mutable_hello()->set_role(v1::ROLE_SUPERVISOR);
  peers.say("s", supervisor);
  peers.say("s", Peers::request(7));
  const std::vector<Call> calls = peers.barrier.calls.take();
  ASSERT_EQ(calls.size(), 1U);
  EXPECT_TRUE(can_hear(peers.barrier, calls[0]));
  peers.say("s", Peers::leave());
  peers.say("s", supervisor);
  EXPECT_FALSE(can_hear(peers.barrier, calls[0]));
  peers.inboxes.clear();
  answer(peers.barrier, calls[0], [](wire::Outbox& outbox) { outbox.response(7, 0); });
  EXPECT_TRUE(peers.inboxes["s"].empty());
}

TEST(Hello, K5_NoRoleTakesThePlacesOfAnother) {
  const SmallRun small(2);
  Config config;
  config.max_sessions = 2;
  config.max_supervisors = config.max_observers = 1;
  Peers peers(small, config);
  const auto of_role = [](v1::Role role) {
    auto hello = Peers::hello("*");
    hello.mutable_hello()->clear_robots();
    hello.mutable_hello()->set_role(role);
    return hello;
  };
  for (const v1::Role role : {v1::ROLE_OBSERVER, v1::ROLE_SUPERVISOR}) {
    const std::string name = v1::Role_Name(role);
    peers.say(name, of_role(role));
    EXPECT_TRUE(peers.told(name).has_welcome()) << name;
    peers.say("second " + name, of_role(role));
    EXPECT_EQ(peers.told("second " + name).refusal().error().code(), v1::Error::TOO_MANY) << name;
  }
  peers.join("q", "robot0");
  peers.join("p", "robot1");
}

TEST(Hello, K5_ThereAre256ObserversAnd64Supervisors) {
  const SmallRun small(1);
  Peers peers(small);
  for (const auto& [role, most] : {std::pair{v1::ROLE_OBSERVER, 256}, {v1::ROLE_SUPERVISOR, 64}}) {
    auto hello = Peers::hello("*");
    hello.mutable_hello()->clear_robots();
    hello.mutable_hello()->set_role(role);
    for (int i = 0; i <= most; ++i) {
      const std::string name = v1::Role_Name(role) + std::to_string(i);
      peers.say(name, hello);
      const auto told = peers.told(name);
      EXPECT_EQ(told.has_welcome(), i < most) << name;
      EXPECT_EQ(told.has_refusal(), i == most) << name;
    }
  }
  EXPECT_EQ(peers.join("p", "*").robots_size(), 1);
}

TEST(Hello, TooManyPatterns) {
  const SmallRun small(1);
  Peers peers(small);
  auto hello = Peers::hello("*");
  for (int i = 0; i < 64; ++i) hello.mutable_hello()->add_robots("*a");
  EXPECT_EQ(refused(peers, hello).code(), v1::Error::TOO_MANY);
}

}  // namespace
}  // namespace ziggurat::network
