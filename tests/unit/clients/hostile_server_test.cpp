// The client against a server that lies: its texts, versions and sizes.

#include <gtest/gtest.h>

#include "fake_server.h"
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
  for (int i = 0; i < 1000; ++i) welcome.mutable_welcome()->mutable_robots(0)->add_joint_sensors()->set_id(hostile);
  welcome.mutable_welcome()->mutable_robots(0)->set_id(hostile);
  FakeServer server([&](FakeServer& self) {
    self.welcome(welcome);
    v1::ServerMessage end;
    end.mutable_end()->set_message(hostile + std::string(1'000'000, 'w'));
    self.send(end);
  });
  Session session(options_for(server));
  const auto expect_printable_exception = [](const auto& call) {
    try {
      call();
      ADD_FAILURE() << "no exception";
    } catch (const std::out_of_range& caught) {
      expect_printable(caught.what());
    }
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
  try {
    const Session session(options_for(server));
    ADD_FAILURE() << "no exception";
  } catch (const ConnectionError& caught) {
    EXPECT_NE(std::string(caught.what()).find(words), std::string::npos) << caught.what();
  }
}

TEST(HostileServer, RefusesAWelcomeOfAnotherMajorVersion) {
  v1::ServerMessage welcome = FakeServer::two_robots();
  welcome.mutable_welcome()->mutable_version()->set_major(9);
  welcome.mutable_welcome()->mutable_version()->set_minor(4);
  expect_no_session(welcome.SerializeAsString(),
                    "the server speaks version 9.4 of the protocol, this client 1.");
}

/// A field of a ServerMessage.
std::string with_length(char tag, const std::string& content) {
  std::string bytes(1, tag);
  for (std::size_t rest = content.size(); rest > 0; rest >>= 7) {
    bytes += static_cast<char>((rest & 0x7f) | (rest >= 0x80 ? 0x80 : 0));
  }
  return bytes + content;
}

TEST(HostileServer, DecodesNoWelcomeThatCouldTakeAllMemory) {
  std::string robots = FakeServer::two_robots().welcome().SerializeAsString();
  const auto message = [](const std::string& welcome) { return with_length('\x0a', welcome); };
  for (int i = 0; i < (1 << 18); ++i) robots.append("\x52\x00", 2);
  expect_no_session(message(robots), "this client takes 262144 at most");
  for (int i = 0; i < (1 << 21); ++i) robots.append("\x52\x00", 2);
  expect_no_session(message(robots), "more than 2097152 fields");
  expect_no_session(message(std::string(65 << 20, '\x52')), "bytes, more than 67108864");
}

/// A session that gets this as its first observation.
/// @return  what next() throws; `left`: the message of its Leave
std::string error_of(const std::string& observation, std::string* left = nullptr) {
  FakeServer server([&](FakeServer& self) {
    self.welcome();
    self.send_bytes(observation);
    const std::string message = self.receive().leave().message();
    if (left != nullptr) *left = message;
  });
  try {
    Session session(options_for(server));
    session.next();
  } catch (const ConnectionError& caught) {
    return caught.what();
  }
  return {};
}

TEST(HostileServer, DecodesNoObservationThatCouldTakeAllMemory) {
  std::string messages;
  for (int i = 0; i < 40 << 20; ++i) messages.append("\x22\x00", 2);  // empty ones from radios
  std::string left;
  const std::string error = error_of(with_length('\x1a', messages), &left);
  EXPECT_NE(error.find("takes more than 2684354560 bytes of memory"), std::string::npos) << error;
  EXPECT_NE(error.find("run fewer robots in each session"), std::string::npos) << error;
  EXPECT_EQ(left, error) << "the server is told why";
}

TEST(HostileServer, TakesObservationsOfMillionsOfTags) {
  v1::ServerMessage message;
  v1::Observation& seen = *message.mutable_observation();
  for (int i = 0; i < 5 << 19; ++i) seen.add_tag_payloads("7");
  seen.mutable_joint_readings()->Resize(4, 0.0);
  const std::string error = error_of(message.SerializeAsString());
  EXPECT_NE(error.find("sent 2621440 payloads of tags seen; it had announced 0"), std::string::npos) << "decoded: " << error;
}

}  // namespace
}  // namespace ziggurat
