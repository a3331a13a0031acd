// SPDX-License-Identifier: MIT
// Connections that are lost, against a server that the test scripts.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "fake_server.h"
#include "words_of.h"
#include "ziggurat/v1/protocol.pb.h"
#include "ziggurat/ziggurat.h"

namespace ziggurat {
namespace {

using std::chrono::milliseconds;

/// The client comes back with its token.
void expect_resumed(FakeServer& server,
                    const v1::ServerMessage& welcome = FakeServer::two_robots()) {
  EXPECT_EQ(server.receive().hello().session_token(), "token");
  server.send(welcome);
}

v1::ServerMessage fatal(v1::Error::Code code) {
  v1::ServerMessage message;
  message.mutable_error()->set_code(code);
  message.mutable_error()->set_severity(v1::Error::FATAL);
  return message;
}

v1::ServerMessage refusal(v1::Error::Code code) {
  v1::ServerMessage message;
  message.mutable_refusal()->mutable_error()->set_code(code);
  return message;
}

TEST(Resuming, ALostAnswerIsSentAgainAndNoTickIsSeenTwice) {
  FakeServer server([](FakeServer& self) {
    self.welcome();
    self.observe(3, {0, 0, 0, 0});
    const v1::Command first = self.receive().command();
    EXPECT_EQ(first.log_size(), 1);
    self.cut();
    expect_resumed(self);
    self.observe(3, {0, 0, 0, 0});
    EXPECT_EQ(self.receive().command().SerializeAsString(), first.SerializeAsString());
    self.observe(4, {0, 0, 0, 0});
    const v1::Command next = self.receive().command();
    EXPECT_EQ(next.tick(), 4U);
    EXPECT_EQ(next.joint_targets_size(), 2) << "all values";
    EXPECT_EQ(next.joint_targets(0), 9);
    EXPECT_EQ(next.log_size(), 0);
    self.end();
    EXPECT_EQ(self.receive().leave().reason(), v1::Leave::DONE);
  });
  Session session(options_for(server));
  ASSERT_TRUE(session.next());
  session.robot("a").joint("hinge").set_target(9);
  session.robot("a").log("once");
  ASSERT_TRUE(session.next());
  EXPECT_EQ(session.tick(), 4U);
  EXPECT_EQ(session.event(), Event::step);
  EXPECT_EQ(session.resumes(), 1U);
  EXPECT_FALSE(session.next());
  EXPECT_TRUE(session.ending());
}

TEST(Resuming, WhatIsHeardStaysThoughTheMessageComesAgain) {
  v1::ServerMessage heard;  // two of them are more than messages keep their memory for
  heard.mutable_observation()->set_tick(3);
  heard.mutable_observation()->add_radio_messages()->mutable_payload()->assign(40 << 20, 'x');
  v1::ServerMessage welcome;
  welcome.mutable_welcome()->mutable_version()->set_major(1);
  welcome.mutable_welcome()->set_session_token("token");
  welcome.mutable_welcome()->set_max_message_bytes(1 << 20);
  v1::RobotDescription& robot = *welcome.mutable_welcome()->add_robots();
  robot.set_id("a");
  robot.add_radios()->set_receives(true);
  FakeServer server([&](FakeServer& self) {
    self.welcome(welcome);
    self.send(heard);
    self.receive();
    self.cut();
    expect_resumed(self, welcome);
    self.send(heard);
    self.receive();
    self.finish();
  });
  Session session(options_for(server));
  ASSERT_TRUE(session.next());
  EXPECT_FALSE(session.next());
  ASSERT_EQ(session.robots()[0].radios().size(), 1U);
  const auto& received = session.robots()[0].radios()[0].received();
  ASSERT_EQ(received.size(), 1U);
  EXPECT_EQ(std::count(received[0].begin(), received[0].end(), 'x'), 40 << 20);
}

TEST(Resuming, TheWorldMayHaveGoneOn) {
  FakeServer server([](FakeServer& self) {
    self.welcome();
    self.observe(3, {0, 0, 0, 0});
    self.receive();
    self.cut();
    v1::ServerMessage welcome = FakeServer::two_robots();
    welcome.mutable_welcome()->mutable_resumed()->add_gone_robots(1);
    expect_resumed(self, welcome);
    self.observe(70, {0, 0, 0, 0});
    EXPECT_EQ(self.receive().command().tick(), 70U);
    self.finish();
  });
  Session session(options_for(server));
  ASSERT_TRUE(session.next());
  ASSERT_TRUE(session.next());
  EXPECT_EQ(session.tick(), 70U);
  EXPECT_TRUE(session.robot("b").gone());
  EXPECT_FALSE(session.next());
}

TEST(Resuming, AResetMeanwhileIsToldAsOne) {
  for (const std::uint64_t seed : {7U, 8U}) {
    FakeServer server([seed](FakeServer& self) {
      self.welcome();
      self.observe(3, {0, 0, 0, 0});
      self.receive();
      self.cut();
      v1::ServerMessage welcome = FakeServer::two_robots();
      welcome.mutable_welcome()->set_seed(seed);
      expect_resumed(self, welcome);
      self.observe(seed == 7 ? 2 : 3, {0, 0, 0, 0});
      EXPECT_NE(self.receive().command().tick(), 0U);
      self.finish();
    });
    Session session(options_for(server));
    ASSERT_TRUE(session.next());
    session.robot("a").joint("hinge").set_target(9);
    ASSERT_TRUE(session.next());
    EXPECT_EQ(session.event(), Event::reset);
    EXPECT_EQ(session.seed(), seed);
    EXPECT_EQ(session.robot("a").joint("hinge").target(), 0);
    EXPECT_FALSE(session.next());
  }
}

TEST(Resuming, BeforeTheFirstTick) {
  FakeServer server([](FakeServer& self) {
    self.welcome();
    self.cut();
    expect_resumed(self);
    self.observe(0, {0, 0, 0, 0});
    self.receive();
    self.finish();
  });
  Session session(options_for(server));
  ASSERT_TRUE(session.next());
  EXPECT_EQ(session.event(), Event::init);
  EXPECT_FALSE(session.next());
}

TEST(Resuming, FailuresAreToldAgainUnlessTheRobotHasLeft) {
  FakeServer server([](FakeServer& self) {
    self.welcome();
    self.observe(3, {0, 0, 0, 0});
    for (int i = 0; i < 3; ++i) self.receive();
    self.cut();
    v1::ServerMessage welcome = FakeServer::two_robots();
    welcome.mutable_welcome()->mutable_resumed()->add_gone_robots(0);
    expect_resumed(self, welcome);
    self.observe(3, {0, 0, 0, 0});
    EXPECT_EQ(self.receive().leave().robots(0), 1U);
    EXPECT_EQ(self.receive().command().tick(), 3U);
    self.finish();
  });
  Session session(options_for(server));
  ASSERT_TRUE(session.next());
  session.robot("a").fail("one");
  session.robot("b").fail("two");
  EXPECT_FALSE(session.next());
}

TEST(Resuming, WhenTheServerDoesNotKnowTheConnection) {
  FakeServer server([](FakeServer& self) {
    self.welcome();
    self.observe(0, {0, 0, 0, 0});
    self.receive();
    self.send(fatal(v1::Error::OUT_OF_STATE));
    expect_resumed(self);
    self.observe(1, {0, 0, 0, 0});
    EXPECT_EQ(self.receive().command().tick(), 1U);
    self.finish();
  });
  Session session(options_for(server));
  ASSERT_TRUE(session.next());
  ASSERT_TRUE(session.next());
  EXPECT_FALSE(session.next());
}

TEST(Resuming, WhenTheServerIsSilent) {
  FakeServer server([](FakeServer& self) {
    v1::ServerMessage welcome = FakeServer::two_robots();
    welcome.mutable_welcome()->set_wall_heartbeat_ms(100);
    self.welcome(welcome);
    self.observe(0, {0, 0, 0, 0});
    EXPECT_TRUE(self.receive().has_command());
    expect_resumed(self, welcome);  // after 3 s
    self.observe(0, {0, 0, 0, 0});
    EXPECT_TRUE(self.receive().has_command());
    self.finish();
  });
  Session session(options_for(server));
  ASSERT_TRUE(session.next());
  EXPECT_FALSE(session.next());
  EXPECT_EQ(session.resumes(), 1U);
}

TEST(Resuming, ASessionThatIsOverIsAnError) {
  FakeServer server([](FakeServer& self) {
    self.welcome();
    self.cut();
    self.receive();
    self.send(refusal(v1::Error::NO_SUCH_SESSION));
  });
  Session session(options_for(server));
  try {
    session.next();
    FAIL();
  } catch (const ProtocolError& error) {
    EXPECT_EQ(error.details().code, "NO_SUCH_SESSION");
    EXPECT_NE(std::string(error.what()).find("closed the connection"), std::string::npos);
  }
  EXPECT_FALSE(session.next());
}

TEST(Resuming, OtherRobotsAreAnError) {
  FakeServer server([](FakeServer& self) {
    self.welcome();
    self.cut();
    v1::ServerMessage welcome = FakeServer::two_robots();
    welcome.mutable_welcome()->mutable_robots()->SwapElements(0, 1);
    expect_resumed(self, welcome);
  });
  Session session(options_for(server));
  EXPECT_THROW(session.next(), ProtocolError);
}

TEST(Resuming, IsNotTriedForever) {
  FakeServer server([](FakeServer& self) {
    self.welcome();
    self.stop_listening();
  });
  Options options = options_for(server);
  options.resume_timeout = milliseconds{300};
  Session session(options);
  EXPECT_TRUE(fails_with<ConnectionError>("not resumed within 300 ms", [&] { session.next(); }));
  EXPECT_FALSE(session.next());
}

TEST(Resuming, IsNotTriedIfItIsNotWanted) {
  FakeServer server([](FakeServer& self) {
    self.welcome();
    self.cut();
    EXPECT_EQ(self.receive().hello().client_name(), "another") << "not the first one again";
  });
  Options options = options_for(server);
  options.resume_timeout = milliseconds{0};
  Session session(options);
  EXPECT_THROW(session.next(), ConnectionError);
  EXPECT_FALSE(session.next());
  options.name = "another";
  options.connect_timeout = milliseconds{500};
  EXPECT_THROW(Session{options}, ConnectionError);
}

TEST(Resuming, AnAnswerThatTheServerClosesTheConnectionForIsNotSentForever) {
  FakeServer server([](FakeServer& self) {
    self.welcome();
    self.observe(0, {0, 0, 0, 0});
    self.receive();
    for (int i = 0; i < 3; ++i) {
      self.cut();
      expect_resumed(self);
      self.observe(0, {0, 0, 0, 0});
      EXPECT_TRUE(self.receive().has_command());
    }
    self.cut();
    self.stop_listening();
  });
  Session session(options_for(server));
  ASSERT_TRUE(session.next());
  EXPECT_THROW(session.next(), ConnectionError);
}

TEST(Resuming, MayBeInterrupted) {
  FakeServer server([](FakeServer& self) {
    self.welcome();
    self.stop_listening();
  });
  Options options = options_for(server);
  bool is_lost = false;
  options.is_interrupted = [&] { return is_lost; };
  Session session(options);
  is_lost = true;
  EXPECT_FALSE(session.next());
  EXPECT_FALSE(session.ending());
}

TEST(Options, TheTokenInTheEnvironmentIsTakenOnce) {
  ::setenv("ZIGGURAT_ENDPOINT", "tcp://127.0.0.1:1", 1);
  ::setenv("ZIGGURAT_SESSION_TOKEN", "00fFa07a", 1);
  EXPECT_EQ(Options::from_environment().session_token, std::string("\0\xff\xa0z", 4));
  EXPECT_EQ(Options::from_environment().session_token, "");
  for (const char* wrong : {"abc", "0x", "zz", "00 1"}) {
    ::setenv("ZIGGURAT_SESSION_TOKEN", wrong, 1);
    const std::string words = words_of<std::invalid_argument>([&] { take_session_token(); });
    EXPECT_NE(words, "") << wrong;
    EXPECT_EQ(words.find(wrong), std::string::npos) << "a secret is not printed";
  }
  ::unsetenv("ZIGGURAT_SESSION_TOKEN");
}

}  // namespace
}  // namespace ziggurat
