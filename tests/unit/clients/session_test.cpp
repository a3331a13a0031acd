// SPDX-License-Identifier: MIT
// The client against a server that the test scripts.

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>

#include "fake_server.h"
#include "words_of.h"
#include "ziggurat/v1/protocol.pb.h"
#include "ziggurat/ziggurat.h"

namespace ziggurat {
namespace {

using std::chrono::milliseconds;

TEST(Session, DevicesAreFoundByNameOnce) {
  FakeServer server([](FakeServer& self) {
    self.welcome();
    self.observe(0, {0, 0, 0, 0});
    EXPECT_EQ(self.receive().command().joint_targets_size(), 0);  // nothing new
    self.observe(1, {1, 2, 3, 4});
    const auto command = self.receive().command();
    EXPECT_EQ(command.tick(), 1U);
    ASSERT_EQ(command.joint_targets_size(), 2);
    EXPECT_EQ(command.joint_targets(0), 0);
    EXPECT_EQ(command.joint_targets(1), 9);
    self.end();
    EXPECT_EQ(self.receive().leave().reason(), v1::Leave::DONE);
  });
  Session session(options_for(server));
  EXPECT_EQ(session.seed(), 7U);
  EXPECT_EQ(session.tick_length(), std::chrono::milliseconds(50));
  Robot& robot = session.robot("b");
  EXPECT_EQ(robot.params().at(0).second, "3");
  ASSERT_EQ(robot.joints().size(), 2U);
  Joint& hinge = robot.joint("hinge");
  Joint& slide = robot.joint("slide");
  EXPECT_EQ(hinge.encoder_mode(), JointMode::position);
  EXPECT_EQ(hinge.motor_mode(), JointMode::velocity);
  EXPECT_EQ(hinge.max_impulse(), 0.5);
  EXPECT_FALSE(slide.has_motor());
  EXPECT_THROW(slide.set_target(1), std::logic_error);
  EXPECT_THROW(hinge.set_target(std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
  ASSERT_TRUE(session.next());
  EXPECT_EQ(session.event(), Event::init);
  ASSERT_TRUE(session.next());
  EXPECT_EQ(session.event(), Event::step);
  EXPECT_EQ(session.time(), std::chrono::milliseconds(50));
  EXPECT_EQ(slide.encoder(), 3);
  EXPECT_EQ(hinge.encoder(), 4);
  EXPECT_EQ(session.robot("a").joint("hinge").encoder(), 2);
  hinge.set_target(9);
  EXPECT_EQ(hinge.target(), 9);
  EXPECT_FALSE(session.next());
  EXPECT_FALSE(session.next());
}

TEST(Session, UnknownIdsListTheKnownOnes) {
  FakeServer server([](FakeServer& self) {
    self.welcome();
    self.receive();
  });
  Session session(options_for(server));
  const std::string words = words_of<std::out_of_range>([&] { session.robot("c"); });
  EXPECT_EQ(words, "this session has no robot 'c'; it has 'a', 'b'");
  EXPECT_TRUE(fails_with<std::out_of_range>("'slide', 'hinge'",
                                            [&] { session.robot("a").joint("wheel"); }));
}

TEST(Session, AResumedOneBeginsWithWhatWasCommanded) {
  FakeServer server([](FakeServer& self) {
    const v1::Hello hello = self.receive().hello();
    EXPECT_EQ(hello.session_token(), "token");
    EXPECT_EQ(hello.version().minor(), 5U);
    v1::ServerMessage message;
    message.mutable_welcome()->mutable_version()->set_major(1);
    for (const char* id : {"a", "b"}) {
      v1::RobotDescription& robot = *message.mutable_welcome()->add_robots();
      robot.set_id(id);
      robot.add_joint_actuators()->set_id("hinge");
    }
    v1::Resumed& resumed = *message.mutable_welcome()->mutable_resumed();
    resumed.mutable_commanded()->add_joint_targets(3);
    resumed.mutable_commanded()->add_joint_targets(4);
    resumed.add_gone_robots(1);
    resumed.add_gone_robots(9);  // that is none of the session's
    self.send(message);
    self.observe(5, {});
    const v1::Command command = self.receive().command();
    ASSERT_EQ(command.joint_targets_size(), 2);
    EXPECT_EQ(command.joint_targets(0), 7);
    EXPECT_EQ(command.joint_targets(1), 4) << "not overwritten";
    self.finish();
  });
  Options options = options_for(server);
  options.session_token = "token";
  Session session(options);
  EXPECT_EQ(session.robot("a").joint("hinge").target(), 3);
  EXPECT_FALSE(session.robot("a").gone());
  EXPECT_TRUE(session.robot("b").gone());
  ASSERT_TRUE(session.next());
  session.robot("a").joint("hinge").set_target(7);
  EXPECT_FALSE(session.next());
}

v1::ServerMessage warning(v1::Error::Code code) {
  v1::ServerMessage message;
  message.mutable_error()->set_code(code);
  message.mutable_error()->set_severity(v1::Error::WARNING);
  return message;
}

TEST(Session, IsToldOfRobotsThatWereRemovedOrTakenOver) {
  FakeServer server([](FakeServer& self) {
    self.welcome();
    for (const char* id : {"b", "of another client"}) {
      v1::ServerMessage message = warning(v1::Error::NOT_YOURS);
      message.mutable_error()->set_robot(id);
      self.send(message);
    }
    self.observe(4, {0, 0, 0, 0});
    self.finish();
    self.receive();
  });
  Session session(options_for(server));
  ASSERT_TRUE(session.next());
  EXPECT_FALSE(session.robot("a").gone());
  EXPECT_TRUE(session.robot("b").gone());
  EXPECT_FALSE(session.next());
}

TEST(Session, IsToldOfDroppedAndSpawnedRobots) {
  FakeServer server([](FakeServer& self) {
    self.welcome();
    v1::ServerMessage message = warning(v1::Error::ROBOTS_DROPPED);
    message.mutable_error()->mutable_dropped()->add_robots(1);
    self.send(message);
    message.mutable_robot_spawned()->set_robot("c");
    message.mutable_robot_spawned()->set_controller("swarm");
    message.mutable_robot_spawned()->set_tick(3);
    self.send(message);
    self.observe(4, {0, 0, 0, 0});
    self.finish();
    self.receive();
  });
  Session session(options_for(server));
  ASSERT_TRUE(session.next());
  EXPECT_FALSE(session.robot("a").gone());
  EXPECT_TRUE(session.robot("b").gone());
  const std::vector<SpawnedRobot> spawned = session.take_spawned();
  ASSERT_EQ(spawned.size(), 1U);
  EXPECT_EQ(spawned[0].id, "c");
  EXPECT_EQ(spawned[0].controller, "swarm");
  EXPECT_EQ(spawned[0].tick, 3U);
  EXPECT_TRUE(session.take_spawned().empty());
  EXPECT_FALSE(session.next());
}

TEST(Session, ResetIsDeliveredWithTheNextObservation) {
  FakeServer server([](FakeServer& self) {
    self.welcome();
    self.observe(0, {0, 0, 0, 0});
    EXPECT_EQ(self.receive().command().joint_targets_size(), 2);
    self.reset();
    self.observe(0, {0, 0, 0, 0});
    EXPECT_EQ(self.receive().command().joint_targets_size(), 0);  // the server's targets are 0, too
    self.finish();
  });
  Session session(options_for(server));
  ASSERT_TRUE(session.next());
  session.robot("a").joint("hinge").set_target(4);
  ASSERT_TRUE(session.next());
  EXPECT_EQ(session.event(), Event::reset);
  EXPECT_EQ(session.seed(), 8U);
  EXPECT_EQ(session.robot("a").joint("hinge").target(), 0);
  EXPECT_FALSE(session.next());
}

TEST(Session, AnAnswerThatCrossedAResetIsIgnored) {
  for (const auto code :
       {v1::Error::FUTURE_TICK, v1::Error::STALE_TICK, v1::Error::DUPLICATE_TICK}) {
    FakeServer server([code](FakeServer& self) {
      self.welcome();
      self.observe(5, {0, 0, 0, 0});
      v1::ServerMessage reset, error;
      reset.mutable_reset()->set_seed(8);
      self.send(reset);
      self.observe(0, {0, 0, 0, 0});
      EXPECT_EQ(self.receive().command().tick(), 5U);
      error.mutable_error()->set_code(code);
      error.mutable_error()->set_severity(v1::Error::DISCARD);
      self.send(error);
      EXPECT_EQ(self.receive().command().joint_targets(1), 4);
      self.observe(1, {0, 0, 0, 0});
      const auto command = self.receive().command();
      EXPECT_EQ(command.tick(), 1U);
      ASSERT_EQ(command.joint_targets_size(), 2);  // in case that the answer to 0 was the lost one
      EXPECT_EQ(command.joint_targets(1), 4);
      self.finish();
    });
    Session session(options_for(server));
    ASSERT_TRUE(session.next());
    ASSERT_TRUE(session.next());
    EXPECT_EQ(session.event(), Event::reset);
    session.robot("b").joint("hinge").set_target(4);
    ASSERT_TRUE(session.next());
    EXPECT_EQ(session.tick(), 1U);
    EXPECT_FALSE(session.next());
  }
}

TEST(Session, AnAnswerForAFutureTickIsOtherwiseAnError) {
  FakeServer server([](FakeServer& self) {
    self.welcome();
    self.observe(5, {0, 0, 0, 0});
    self.receive();
    self.discard(v1::Error::FUTURE_TICK);
    self.receive();
  });
  Session session(options_for(server));
  ASSERT_TRUE(session.next());
  EXPECT_THROW(session.next(), ProtocolError);
}

TEST(Session, LogsAndFailuresAreSentWithTheAnswer) {
  FakeServer server([](FakeServer& self) {
    self.welcome();
    self.observe(0, {0, 0, 0, 0});
    const auto leave = self.receive().leave();
    ASSERT_EQ(leave.robots_size(), 1);
    EXPECT_EQ(leave.robots(0), 1U);
    EXPECT_EQ(leave.reason(), v1::Leave::FAILED);
    EXPECT_EQ(leave.message(), "oh");
    const auto command = self.receive().command();
    ASSERT_EQ(command.log_size(), 2);
    EXPECT_EQ(command.log(0).text(), "one");
    EXPECT_FALSE(command.log(0).error());
    EXPECT_EQ(command.log(1).text(), "two \xEF\xBF\xBD");
    EXPECT_TRUE(command.log(1).error());
    self.end();
    const auto last = self.receive().leave();
    EXPECT_EQ(last.robots_size(), 0);
    ASSERT_EQ(last.log_size(), 1);
    EXPECT_EQ(last.log(0).text(), "three");
  });
  Session session(options_for(server));
  ASSERT_TRUE(session.next());
  session.robot("a").log("one");
  session.robot("b").log_error("two \xff");
  session.robot("b").fail("oh");
  session.robot("b").fail("only the first counts");
  EXPECT_TRUE(session.robot("b").failed());
  EXPECT_FALSE(session.next());
  session.robot("a").log("three");
}

TEST(Session, TooManyLogLinesAreAnError) {
  FakeServer server([](FakeServer& self) {
    self.welcome();
    self.receive();
  });
  Session session(options_for(server));
  const std::string line(100'000, 'x');
  EXPECT_THROW(for (int i = 0; i < 100; ++i) session.robot("a").log(line), std::length_error);
}

TEST(Session, ARefusalIsATypedException) {
  FakeServer server([](FakeServer& self) {
    self.receive();
    v1::ServerMessage message;
    auto& refusal = *message.mutable_refusal();
    refusal.mutable_error()->set_code(v1::Error::ROBOT_TAKEN);
    refusal.mutable_error()->set_robot("a");
    refusal.mutable_error()->set_retryable(true);
    refusal.mutable_error()->set_message("Robot 'a' belongs to another client.");
    refusal.set_holder("another client");
    self.send(message);
  });
  try {
    const Session session(options_for(server));
    FAIL();
  } catch (const ProtocolError& error) {
    EXPECT_EQ(error.details().code, "ROBOT_TAKEN");
    EXPECT_EQ(error.details().robot, "a");
    EXPECT_EQ(error.details().holder, "another client");
    EXPECT_TRUE(error.details().retryable);
    EXPECT_STREQ(error.what(), "ROBOT_TAKEN: Robot 'a' belongs to another client.");
  }
}

TEST(Session, AnErrorEndsTheLoopAndIsSentToTheServer) {
  FakeServer server([](FakeServer& self) {
    self.welcome();
    self.observe(0, {0, 0, 0, 0});
    self.receive();
    self.discard(v1::Error::BAD_VALUE);
    EXPECT_EQ(self.receive().leave().reason(), v1::Leave::FAILED);
  });
  EXPECT_THROW(
      {
        Session session(options_for(server));
        while (session.next()) {
        }
      },
      ProtocolError);
}

TEST(Session, UnknownMessagesAndHeartbeatsAreIgnored) {
  FakeServer server([](FakeServer& self) {
    self.welcome();
    v1::ServerMessage message;
    message.mutable_heartbeat()->set_sequence(1);
    self.send(message);
    message.mutable_paused();
    self.send(message);
    self.send_bytes("\xfa\x01\x01x");  // field 31, of a later version
    self.observe(0, {0, 0, 0, 0});
    EXPECT_TRUE(self.receive().has_command());  // and no answer to the heartbeat
    self.finish();
  });
  Session session(options_for(server));
  EXPECT_TRUE(session.next());
  EXPECT_FALSE(session.next());
}

TEST(Session, AnObservationOfTheWrongSizeIsRefused) {
  FakeServer server([](FakeServer& self) {
    self.welcome();
    self.observe(0, {1, 2, 3});
    self.receive();
  });
  Session session(options_for(server));
  EXPECT_THROW(session.next(), ConnectionError);
}

TEST(Session, InvalidBytesAreAnError) {
  FakeServer server([](FakeServer& self) {
    self.receive();
    self.send_bytes("HTTP/1.1 400 Bad Request");
  });
  EXPECT_THROW(Session(options_for(server)), ConnectionError);
}

TEST(Session, SilenceIsATimeOut) {
  FakeServer server([](FakeServer& self) {
    self.welcome();
    self.receive();
  });
  Options options = options_for(server);
  options.wait_timeout = milliseconds{50};
  Session session(options);
  const std::string words = words_of<ConnectionError>([&] { session.next(); });
  EXPECT_NE(words.find(server.endpoint), std::string::npos);
  EXPECT_NE(words.find("50 ms"), std::string::npos);
  EXPECT_THROW(session.next(), ConnectionError);  // still waiting
}

TEST(Session, NoServer) {
  Options options;
  options.endpoint = "ipc://@ziggurat-no-server";
  options.connect_timeout = milliseconds{50};
  EXPECT_THROW(Session{options}, ConnectionError);
  options.endpoint = "nonsense";
  EXPECT_THROW(Session{options}, std::invalid_argument);
}

TEST(Options, FromTheEnvironment) {
  ::unsetenv("ZIGGURAT_ENDPOINT");
  EXPECT_THROW(Options::from_environment(), std::invalid_argument);
  ::setenv("ZIGGURAT_ENDPOINT", "tcp://127.0.0.1:1", 1);
  ::setenv("ZIGGURAT_CONTROLLER", "wheels", 1);
  const Options options = Options::from_environment();
  EXPECT_EQ(options.endpoint, "tcp://127.0.0.1:1");
  EXPECT_EQ(options.controller, "wheels");
}

TEST(Options, AnEndpointThatIsGivenStaysAndATokenIsForTheOtherOne) {
  ::setenv("ZIGGURAT_ENDPOINT", "tcp://127.0.0.1:1", 1);
  ::setenv("ZIGGURAT_SESSION_TOKEN", "7a", 1);
  Options other;
  other.endpoint = "tcp://127.0.0.1:2";
  other.read_environment();
  EXPECT_EQ(other.endpoint, "tcp://127.0.0.1:2");
  EXPECT_EQ(other.session_token, "");
  Options same;
  same.endpoint = "tcp://127.0.0.1:1";
  same.read_environment();
  EXPECT_EQ(same.session_token, "z");
  ::unsetenv("ZIGGURAT_ENDPOINT");
}

}  // namespace
}  // namespace ziggurat
