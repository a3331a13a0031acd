// In which order connections get their messages taken.

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "network/local_server.h"
#include "network/socket.h"

namespace ziggurat::network {
namespace {

using namespace std::string_literals;

/// What a ZeroMQ client without keys sends, all at once and without reading an answer.
std::string greeting_and(int messages, const std::string& content) {
  std::string bytes = "\xFF\0\0\0\0\0\0\0\x01\x7F\x03\0NULL"s + std::string(48, '\0');
  const std::string ready = "\x05READY\x0BSocket-Type\0\0\0\x06" "DEALER"s;
  bytes += '\x04';
  bytes += static_cast<char>(ready.size());
  bytes += ready;
  for (int i = 0; i < messages; ++i) {
    bytes += '\0';
    bytes += static_cast<char>(content.size());
    bytes += content;
  }
  return bytes;
}

Descriptor connect_and_send(const std::string& endpoint, const std::string& bytes) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(std::stoi(endpoint.substr(endpoint.rfind(':') + 1))));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  Descriptor client(::socket(AF_INET, SOCK_STREAM, 0));
  EXPECT_EQ(::connect(client.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_EQ(::send(client.number(), bytes.data(), bytes.size(), 0),
            static_cast<ssize_t>(bytes.size()));
  return client;
}

TEST(Turns, AConnectionThatSendsMuchDoesNotKeepOthersWaiting) {
  constexpr int many = 500;
  Socket socket(local_config());
  const std::string endpoint = socket.endpoints().front();
  const Descriptor busy = connect_and_send(endpoint, greeting_and(many, "busy"));
  const Descriptor other = connect_and_send(endpoint, greeting_and(1, "other"));
  const Descriptor third = connect_and_send(endpoint, greeting_and(1, "third"));
  std::vector<std::string> taken;
  Received received;
  while (taken.size() < many + 2 && socket.poll(patience.timeout, {}) != Socket::Ready::timed_out) {
    while (socket.receive(received)) taken.emplace_back(received.bytes);
  }
  ASSERT_EQ(taken.size(), static_cast<std::size_t>(many + 2));
  for (const char* name : {"other", "third"}) {
    EXPECT_LT(std::ranges::find(taken, name) - taken.begin(), 10) << name;
  }
}

}  // namespace
}  // namespace ziggurat::network
