// SPDX-License-Identifier: MIT
// The client against a server that lies: its texts, versions and sizes.

#include <gtest/gtest.h>

#include "fake_server.h"
#include "words_of.h"
#include "ziggurat/v1/protocol.pb.h"
#include "ziggurat/ziggurat.h"

namespace ziggurat {
namespace {

const std::string hostile = "\x1b]52;c;eA==\x07\u202e\r";

/// No byte of it has an effect on a terminal, and it is short.
void expect_printable(const std::string& text) {
  EXPECT_EQ(text.find_first_of("\x1b\x07\r"), std::string::npos) << text.substr(0, 100);
  EXPECT_EQ(text.find("\u202e"), std::string::npos) << text.substr(0, 100);
  EXPECT_LE(text.size(), 4096U);
}

TEST(HostileServer, TextsOfAServerArePrintableAndBounded) {
  v1::ServerMessage refused;
  v1::Error& error = *refused.mutable_refusal()->mutable_error();
  error.set_code(v1::Error::TOO_MANY);
  error.set_message(hostile + std::string(3'000'000, 'z'));
  error.set_robot(hostile);
  refused.mutable_refusal()->set_holder(hostile + std::string(3'000'000, 'z'));
  FakeServer server([&](FakeServer& self) { self.welcome(refused); });
  try {
    const Session session(options_for(server));
    ADD_FAILURE() << "no exception";
  } catch (const ProtocolError& caught) {
    expect_printable(caught.what());
    expect_printable(caught.details().robot);
    expect_printable(caught.details().holder);
  }
}

TEST(HostileServer, IdsAndEndingsOfAServerArePrintableAndBounded) {
  v1::ServerMessage welcome = FakeServer::two_robots();
  for (int i = 0; i < 1000; ++i)
    welcome.mutable_welcome()->mutable_robots(0)->add_joint_sensors()->set_id(hostile);
  welcome.mutable_welcome()->mutable_robots(0)->set_id(hostile);
  FakeServer server([&](FakeServer& self) {
    self.welcome(welcome);
    v1::ServerMessage end;
    end.mutable_end()->set_message(hostile + std::string(1'000'000, 'w'));
    self.send(end);
  });
  Session session(options_for(server));
  const auto expect_printable_exception = [](const auto& call) {
    const std::string words = words_of<std::out_of_range>(call);
    EXPECT_NE(words, "");
    expect_printable(words);
  };
  expect_printable_exception([&] { session.robot("c"); });
  expect_printable_exception([&] { session.robots()[0].joint("c"); });
  EXPECT_FALSE(session.next());
  expect_printable(session.ending().value().message);
}

void expect_no_session(const std::string& bytes, const char* words) {
  FakeServer server([&](FakeServer& self) {
    self.receive();
    self.send_bytes(bytes);
  });
  EXPECT_TRUE(
      fails_with<ConnectionError>(words, [&] { const Session session(options_for(server)); }));
}

TEST(HostileServer, RefusesAWelcomeOfAnotherMajorVersion) {
  v1::ServerMessage welcome = FakeServer::two_robots();
  welcome.mutable_welcome()->mutable_version()->set_major(9);
  welcome.mutable_welcome()->mutable_version()->set_minor(4);
  expect_no_session(welcome.SerializeAsString(),
                    "the server speaks version 9.4 of the protocol, this client 1.");
}

}  // namespace
}  // namespace ziggurat
