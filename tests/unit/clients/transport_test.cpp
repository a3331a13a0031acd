// SPDX-License-Identifier: MIT
// The connection to a server.

#include "transport.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <zmq.hpp>

#include "waiting.h"
#include "ziggurat/error.h"
#include "ziggurat/ziggurat.h"
#include "zmtp/frame.h"

namespace ziggurat {
namespace {

TEST(Transport, AConnectionThatIsRefusedTellsTheSender) {
  std::array<char, 41> open{}, secret{};
  ASSERT_EQ(zmq_curve_keypair(open.data(), secret.data()), 0);
  zmq::context_t context;
  zmq::socket_t server(context, zmq::socket_type::router);
  server.set(zmq::sockopt::linger, 0);
  server.set(zmq::sockopt::curve_server, 1);
  server.set(zmq::sockopt::curve_secretkey, secret.data());
  server.bind("tcp://127.0.0.1:*");

  SessionOptions without_keys;
  without_keys.endpoint = server.get(zmq::sockopt::last_endpoint);
  const auto transport = make_transport(without_keys);
  // Messages before the refusal is known go into a queue that ZeroMQ then drops.
  const auto send_for_long = [&] {
    comes_true([&] {
      transport->send(1, [](char* to) { *to = 0; });
      return false;
    });
  };
  EXPECT_THROW(send_for_long(), ConnectionError)
      << "without a queue ZeroMQ alone would wait without end";
}

/// RFC 6761: no name that ends with .invalid has an address.
TEST(Endpoints, OfAnUnknownHostAreToldAsSuch) {
  Options options;
  options.endpoint = "tcp://nowhere.invalid:5555";
  options.robots = {"*"};
  options.connect_timeout = std::chrono::milliseconds{200};
  try {
    Session session(options);
    FAIL() << "connected";
  } catch (const ConnectionError& error) {
    EXPECT_STREQ(error.what(), "tcp://nowhere.invalid:5555: no host of that name is known");
  }
}

TEST(Endpoints, ThatNoServerCanListenAtAreToldAtOnce) {
  SessionOptions options;
  const auto complaint = [&](const std::string& endpoint) -> std::string {
    options.endpoint = endpoint;
    try {
      make_transport(options);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "none";
  };
  for (const std::string& key :
       {std::string(), std::string(40, '0')}) {  // what libzmq connects to, too
    options.server_key = key;
    for (const char* port :
         {"99999", "65536", "0", "-1", "", "http", "*", "1x", " 1", "999999999999999999999"}) {
      for (const char* host : {"localhost", "127.0.0.1", "[::1]", "127.0.0.1:0;127.0.0.1"}) {
        EXPECT_NE(complaint("tcp://" + std::string(host) + ":" + port)
                      .find("'" + std::string(port) + "'; it must be a number from 1 to 65535"),
                  std::string::npos)
            << host << ' ' << port;
      }
    }
    for (const char* other :
         {"tcp://", "tcp://:80", "tcp://host", "inproc://x", "ws://localhost:80", "nonsense", ""}) {
      EXPECT_NE(complaint(other).find("write "), std::string::npos) << other;
    }
  }
  options.server_key.clear();
  EXPECT_EQ(complaint("tcp://localhost:65535"), "none");
  EXPECT_EQ(complaint("ipc://@abstract"), "none");
}

/// A server that writes what it likes to one connection, which it has shaken hands with.
class RawServer {
 public:
  RawServer() {
    listener_ = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(::bind(listener_, reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(::listen(listener_, 1), 0);
    ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    options.endpoint = "tcp://127.0.0.1:" + std::to_string(ntohs(address.sin_port));
  }
  ~RawServer() {
    ::close(client_);
    ::close(listener_);
  }
  void shake_hands(Transport& transport) {
    client_ = ::accept(listener_, nullptr, nullptr);
    std::string bytes = zmtp::greeting("NULL", zmtp::End::client);
    zmtp::append_command(bytes, "READY", zmtp::metadata_of("ROUTER"));
    write(bytes);
    std::string heard;
    std::array<char, 256> part;
    while (heard.find("READY") == std::string::npos) {  // the client's, behind its greeting
      const ssize_t count = ::recv(client_, part.data(), part.size(), 0);
      ASSERT_GT(count, 0);
      heard.append(part.data(), static_cast<std::size_t>(count));
    }
    EXPECT_FALSE(transport.was_closed());
  }
  void write(const std::string& bytes) {
    EXPECT_EQ(::send(client_, bytes.data(), bytes.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(bytes.size()));
  }
  static std::string header(std::size_t size) {
    std::string bytes(zmtp::header_length(size), '\0');
    zmtp::write_header(size, reinterpret_cast<std::uint8_t*>(bytes.data()));
    return bytes;
  }

  SessionOptions options;

 private:
  int listener_ = -1, client_ = -1;
};

TEST(Transport, AMessageThatIsTooLongIsNotWaitedFor) {
  RawServer server;
  const auto transport = make_transport(server.options);
  server.shake_hands(*transport);
  server.write(RawServer::header(longest_message + 1));
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!transport->was_closed() && std::chrono::steady_clock::now() < end) {
    EXPECT_FALSE(transport->receive(std::chrono::milliseconds(10)));
  }
  EXPECT_TRUE(transport->was_closed());
}

/// Threads of libzmq are not there in a forked child: it must not wait for them.
TEST(Transport, AForkedChildEndsAndLeavesTheConnectionToItsParent) {
  RawServer server;
  auto transport = make_transport(server.options);
  server.shake_hands(*transport);
  const pid_t child = ::fork();
  if (child == 0) {
    ::alarm(10);
    bool throws = false;
    try {
      transport->send(1, [](char* to) { *to = 0; });
    } catch (const ConnectionError&) {
      throws = true;
    }
    transport->linger();
    transport.reset();
    ::_exit(throws ? 0 : 1);
  }
  int status = -1;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_FALSE(transport->was_closed());
}

}  // namespace
}  // namespace ziggurat
