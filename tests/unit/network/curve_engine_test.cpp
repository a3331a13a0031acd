// SPDX-License-Identifier: MIT
// Attacks of a peer that has the right keys. It sends boxes again, in another order, of another
// length or direction, or steps of the handshake at the wrong time. All end the connection.

#include <gtest/gtest.h>
#include <zmq.h>

#include <span>
#include <string>
#include <vector>

#include "network/curve_client.h"
#include "network/zmtp/engine.h"

namespace ziggurat::network::zmtp {
namespace {

using namespace std::string_literals;
using Step = Taken::Step;

constexpr std::size_t limit = 1000;

std::string z85(const Key& key) {
  std::array<char, 41> text{};
  return zmq_z85_encode(text.data(), key.data(), key.size());
}

/// A server with one listed client, and connections to it.
struct CurveEngine : ::testing::Test {
  struct Connection {
    Connection(const CurveKeys& keys, const CurveClient::Pair& pair)
        : engine(&keys), client(pair, keys.public_key()) {
      EXPECT_EQ(say(greeting("CURVE", End::client)), Step::passed);
    }
    Step say(std::string bytes) {
      reply.clear();
      const std::span input(reinterpret_cast<std::uint8_t*>(bytes.data()), bytes.size());
      const Taken taken = engine.take(input, limit, reply);
      content = taken.step == Step::frame ? std::string(text_of(taken.content)) : std::string();
      has_more = taken.has_more;
      return taken.step;
    }
    void greet() {
      ASSERT_EQ(say(client.hello()), Step::passed);
      client.take_welcome(reply);
    }
    void open() {
      greet();
      ASSERT_EQ(say(client.initiate()), Step::passed);
      ASSERT_TRUE(engine.is_open());
    }
    Step tell(std::uint64_t number, const std::string& text, std::uint8_t flags = 0) {
      return say(CurveClient::frame(client.message(number, "\0"s + text), flags));
    }
    Engine engine;
    CurveClient client;
    std::string reply, content;
    bool has_more = false;
  };
  Connection connect() { return {keys, listed}; }
  Connection open() {
    Connection connection = connect();
    connection.open();
    return connection;
  }

  CurveClient::Pair server = CurveClient::make_pair(), listed = CurveClient::make_pair();
  CurveKeys keys{{z85(server.secret), {{z85(listed.open), {.controller = true}, ""}}}};
};

TEST_F(CurveEngine, MessagesPassWhileTheirNumbersGrow) {
  Connection connection = open();
  for (const std::uint64_t number : {3ULL, 4ULL, 9ULL, ~0ULL}) {
    EXPECT_EQ(connection.tell(number, "text"), Step::frame);
    EXPECT_EQ(connection.content, "text");
  }
}

TEST_F(CurveEngine, AMessageThatIsSentAgainEndsTheConnection) {
  Connection connection = open();
  const std::string frame = CurveClient::frame(connection.client.message(3, "\0command"s));
  EXPECT_EQ(connection.say(frame), Step::frame);
  EXPECT_EQ(connection.say(frame), Step::failed);
}

TEST_F(CurveEngine, MessagesInAnotherOrderEndTheConnection) {
  Connection connection = open();
  EXPECT_EQ(connection.tell(5, "later"), Step::frame);
  EXPECT_EQ(connection.tell(4, "sooner"), Step::failed);
  for (const std::uint64_t number : {0, 1, 2}) {  // those of the handshake
    Connection fresh = open();
    EXPECT_EQ(fresh.tell(number, "text"), Step::failed) << number;
  }
}

TEST_F(CurveEngine, StepsOfTheHandshakeBehindItEndTheConnection) {
  for (const int step : {0, 1, 2, 3}) {
    Connection connection = open();
    std::string ready, error;
    append_command(ready, "READY", metadata_of("DEALER"));
    append_command(error, "ERROR", "\0"s);
    const std::string late[] = {connection.client.hello(7), connection.client.initiate(7), ready,
                                error};
    EXPECT_EQ(connection.say(late[step]), Step::failed) << step;
  }
}

TEST_F(CurveEngine, StepsOfTheHandshakeInAnotherOrderEndTheConnection) {
  Connection twice = connect();
  twice.greet();
  EXPECT_EQ(twice.say(twice.client.hello(2)), Step::failed);
  Connection without_hello = connect();
  without_hello.client.cookie_ = std::string(96, '\0');
  EXPECT_EQ(without_hello.say(without_hello.client.initiate()), Step::failed);
  Connection at_once = connect();
  EXPECT_EQ(at_once.tell(3, "text"), Step::failed);
  Connection before_initiate = connect();
  before_initiate.greet();
  EXPECT_EQ(before_initiate.tell(3, "text"), Step::failed);
  Connection old_number = connect();
  old_number.greet();
  EXPECT_EQ(old_number.say(old_number.client.initiate(1)), Step::failed);
  EXPECT_FALSE(old_number.engine.is_open());
}

TEST_F(CurveEngine, AHandshakeThatIsPlayedBackOpensNothing) {
  Connection real = connect();
  real.greet();
  const std::string hello = real.client.hello(), initiate = real.client.initiate();
  ASSERT_EQ(real.say(initiate), Step::passed);
  Connection played = connect();
  EXPECT_EQ(played.say(hello), Step::passed);
  EXPECT_EQ(played.say(initiate), Step::failed);
  Connection with_cookie = connect();  // another client's, of another connection
  with_cookie.greet();
  with_cookie.client.cookie_ = real.client.cookie_;
  EXPECT_EQ(with_cookie.say(with_cookie.client.initiate()), Step::failed);
}

TEST_F(CurveEngine, AHelloIsExact) {
  const std::string right = connect().client.hello();
  std::vector<std::string> wrong{connect().client.hello(0), connect().client.hello(1, "\2\0"s),
                                 connect().client.hello(1, "\1\1"s)};
  for (const std::size_t at : {0U, 3U, 90U, 130U, 199U}) {
    wrong.push_back(right);
    wrong.back().at(at) ^= 0x40;
  }
  std::string longer = right + "x", shorter = right.substr(0, right.size() - 1);
  ++longer[1], --shorter[1];
  wrong.insert(wrong.end(), {longer, shorter});
  for (std::size_t i = 0; i < wrong.size(); ++i) {
    Connection connection = connect();
    EXPECT_EQ(connection.say(wrong[i]), Step::failed) << i;
  }
}

TEST_F(CurveEngine, AKeyThatHasNoSecretIsRefused) {
  Connection connection = connect();
  std::string hello = connection.client.hello();
  std::fill_n(hello.begin() + 2 + 6 + 74, 32, '\0');  // its product with every key is zero
  EXPECT_EQ(connection.say(hello), Step::failed);
}

TEST_F(CurveEngine, BoxesOfOtherLengthsEndTheConnection) {
  Connection connection = open();
  EXPECT_EQ(connection.tell(3, ""), Step::frame) << "an empty message is one";
  EXPECT_EQ(connection.tell(4, std::string(limit, 'x')), Step::frame);
  EXPECT_EQ(connection.tell(5, std::string(limit + 1, 'x')), Step::too_long);
  for (const std::string& body : {""s, "\x07MESSAGE"s, "\x07MESSAGE"s + CurveClient::bytes(9),
                                  "\x07MESSAGE"s + CurveClient::bytes(9) + std::string(16, 'm')}) {
    Connection fresh = open();
    EXPECT_EQ(fresh.say(CurveClient::frame(body)), Step::failed) << body.size();
  }
  Connection without_flags = open();
  EXPECT_EQ(without_flags.say(CurveClient::frame(without_flags.client.message(3, ""))),
            Step::failed);
}

TEST_F(CurveEngine, MessagesThatNoClientHasSealedEndTheConnection) {
  Connection reflected = open();  // the server's own direction
  EXPECT_EQ(
      reflected.say(CurveClient::frame(reflected.client.message(3, "\0text"s, "CurveZMQMESSAGES"))),
      Step::failed);
  Connection of_another = open();
  EXPECT_EQ(of_another.say(CurveClient::frame(open().client.message(3, "\0text"s))), Step::failed);
  Connection plain = open();
  EXPECT_EQ(plain.say(CurveClient::frame("a message that is not encrypted, and long enough")),
            Step::failed);
  for (std::size_t at : {0U, 9U, 15U, 16U, 36U}) {
    Connection altered = open();
    std::string body = altered.client.message(3, "\0text"s);
    body[at] ^= 1;
    EXPECT_EQ(altered.say(CurveClient::frame(body)), Step::failed) << at;
  }
}

TEST_F(CurveEngine, FlagsOutsideOfTheBoxDecideNothing) {
  Connection connection = open();
  EXPECT_EQ(connection.tell(3, "text", 1), Step::frame);
  EXPECT_FALSE(connection.has_more);
  EXPECT_EQ(connection.tell(4, "\4PING\0\0x"s, 4), Step::frame) << "a message, as its box says";
  EXPECT_EQ(connection.reply, "");
}

}  // namespace
}  // namespace ziggurat::network::zmtp
