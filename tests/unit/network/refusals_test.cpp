// SPDX-License-Identifier: MIT
// Clients that can't talk with the server: each is told of in a line that says what it is and what
// is needed.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>
#include <zmq.hpp>

#include "network/barrier/dispatch.h"
#include "network/keys.h"
#include "network/local_server.h"
#include "network/peers.h"
#include "network/raw_client.h"
#include "network/socket.h"
#include "temporary_folder.h"

namespace ziggurat::network {
namespace {

using namespace std::string_literals;
using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

/// First notice of the server, which serves until then.
std::string line_of(Socket& socket) {
  Received received;
  for (const auto end = Clock::now() + patience.timeout; Clock::now() < end;) {
    EXPECT_FALSE(socket.receive(received));
    if (const auto notices = socket.take_notices(Clock::now()); !notices.empty())
      return notices.front();
    socket.poll(milliseconds{10}, {});
  }
  return {};
}

/// The line on a client of libzmq, which closes a connection by itself when it knows that the
/// server is another.
std::string line_on(Socket& socket, zmq::socket_type type,
                    const std::function<void(zmq::socket_t&)>& set = {}) {
  zmq::context_t context;
  zmq::socket_t client(context, type);
  client.set(zmq::sockopt::linger, 0);
  if (set) set(client);
  client.connect(socket.endpoints().front());
  return line_of(socket);
}

TEST(Refusals, SocketsOfOtherTypesAreNamed) {
  const std::vector<std::pair<zmq::socket_type, std::string>> types{
      {zmq::socket_type::pair, "PAIR"}, {zmq::socket_type::push, "PUSH"},
      {zmq::socket_type::sub, "SUB"},   {zmq::socket_type::req, "REQ"},
      {zmq::socket_type::pub, "PUB"},   {zmq::socket_type::pull, "PULL"}};
  for (const auto& [type, name] : types) {
    Socket socket(local_config());
    EXPECT_EQ(line_on(socket, type), "A client was refused: it is a socket of type " + name +
                                         ", and the server talks with a DEALER.");
  }
}

struct RefusedKeys : ::testing::Test {
  RefusedKeys() {
    write_key_pair(folder / "server");
    write_key_pair(folder / "client");
    config.curve = {read_secret_key(folder / "server.secret"), {}};
    config.curve->clients.push_back({public_key_of(read_secret_key(folder / "client.secret")),
                                     {.controller = true, .supervisor = true, .observer = true},
                                     "",
                                     {}});
  }
  void use_keys(zmq::socket_t& client) const {
    const std::string secret = read_secret_key(folder / "client.secret");
    client.set(zmq::sockopt::curve_serverkey, public_key_of(config.curve->secret_key));
    client.set(zmq::sockopt::curve_secretkey, secret);
    client.set(zmq::sockopt::curve_publickey, public_key_of(secret));
  }
  TemporaryFolder folder;
  Config config = local_config();
};

TEST_F(RefusedKeys, AreNamed) {
  Socket plain(local_config()), secured(config);
  EXPECT_EQ(line_on(plain, zmq::socket_type::dealer, [&](auto& client) { use_keys(client); }),
            "A client was refused: it has keys, and the endpoint is not protected.");
  EXPECT_EQ(
      line_on(secured, zmq::socket_type::dealer),
      "A client was refused: it has no key, and the endpoint is protected (--curve-clients).");
  EXPECT_EQ(
      line_on(secured, zmq::socket_type::push, [&](auto& client) { use_keys(client); }),
      "A client was refused: it is a socket of type PUSH, and the server talks with a DEALER.");
}

TEST(Refusals, PasswordsAreNone) {
  Socket socket(local_config());
  const std::string line = line_on(socket, zmq::socket_type::dealer, [](zmq::socket_t& client) {
    client.set(zmq::sockopt::plain_username, "me");
    client.set(zmq::sockopt::plain_password, "secret");
  });
  EXPECT_EQ(line, "A client was refused: its mechanism is PLAIN, and the endpoint's is NULL.");
}

TEST(Refusals, OlderVersionsAreNamed) {
  const auto line = [](const std::string& said) {
    Socket socket(local_config());
    const posix::Descriptor client = connect_and_send(socket.endpoints().front(), said);
    return line_of(socket);
  };
  EXPECT_EQ(line("\xff\0\0\0\0\0\0\0\1\x7f\1"s),
            "A client was refused: it speaks ZMTP 2.0, and ZMTP 3 is needed (libzmq 4).");
  EXPECT_EQ(line("\1\0"s),
            "A client was refused: it speaks ZMTP 1.0, and ZMTP 3 is needed (libzmq 4).");
  EXPECT_EQ(line("GET / HTTP/1.1\r\n"),
            "A client was refused: what it sends is not ZMTP 3, ZeroMQ's wire protocol.");
}

TEST(Refusals, AMessageOfMoreThanTwiceWhatIsAllowedIsTold) {
  Socket socket(local_config());
  const posix::Descriptor client =
      connect_and_send(socket.endpoints().front(), greeting_and(1, "me"));
  Received received;
  while (!socket.receive(received)) socket.poll(patience.timeout, {});
  socket.set_standing(received.connection, Standing::observer, longest_without_session);
  socket.handled();
  const std::string header = "\2\0\0\0\0\0\2\0\0"s;  // of 128 KiB
  ASSERT_EQ(::send(client.number(), header.data(), header.size(), 0), 9);
  EXPECT_EQ(
      line_of(socket),
      "A client was disconnected: a message of its has about 131081 bytes, and 65536 are allowed.");
}

v1::ClientMessage hello_of_observer() {
  v1::ClientMessage message = Peers::hello("");
  message.mutable_hello()->clear_robots();
  message.mutable_hello()->set_role(v1::ROLE_OBSERVER);
  return message;
}

TEST(Refusals, M7_MessagesThatAreSkippedCountByTheirSize) {
  const SmallRun small(1);
  Peers peers(small);
  peers.say("p", hello_of_observer());
  int answered = 0;
  for (bool is_refused = false; !is_refused && answered < 1000; ++answered) {
    // A good message between them: they are no hundred in a row.
    peers.say("p", Peers::request(static_cast<std::uint64_t>(answered)));
    peers.barrier.calls.take();
    peers.barrier.calls.forget(peers.barrier.connections.session_of("p"));
    peers.inboxes["p"].clear();
    receive(peers.barrier, {.connection = "p", .bytes = {}, .skipped = 65 * kibibyte},
            &peers.commands);
    const auto told = peers.told("p").error();
    is_refused = told.code() == v1::Error::TOO_MANY;
    EXPECT_TRUE(is_refused || told.code() == v1::Error::TOO_LARGE);
  }
  EXPECT_NEAR(answered, 2000 / (2 + 65 / 4), 5);
}

TEST(Refusals, SessionsThatAreLostFillNoLog) {
  const SmallRun small(1);
  Peers peers(small);
  std::vector<std::string> told;
  for (int i = 0; i < 500; ++i) {
    const std::string name = "o" + std::to_string(i);
    peers.say(name, hello_of_observer());
    disconnect(peers.barrier, name);
    for (const std::string& line : peers.barrier.journal.take(peers.now).notices)
      told.push_back(line);
  }
  EXPECT_EQ(told.size(), 20U);
  peers.join("driver", "robot0");
  disconnect(peers.barrier, "driver");
  const auto notices = peers.take_report().notices;
  ASSERT_EQ(notices.size(), 1U) << "what others do does not hide it";
  EXPECT_NE(notices[0].find("is lost: its connection is gone"), std::string::npos) << notices[0];
}

}  // namespace
}  // namespace ziggurat::network
