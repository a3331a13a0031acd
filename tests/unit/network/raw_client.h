// SPDX-License-Identifier: MIT
#pragma once
// A ZeroMQ client without keys that sends what the test says and reads nothing.

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <string>

#include "posix/descriptor.h"

namespace ziggurat::network {

/// Bytes that a ZeroMQ client without keys sends, all at once and without reading an answer.
inline std::string greeting_and(int messages, const std::string& content) {
  using namespace std::string_literals;
  std::string bytes = "\xFF\0\0\0\0\0\0\0\x01\x7F\x03\0NULL"s + std::string(48, '\0');
  const std::string ready =
      "\x05READY\x0BSocket-Type\0\0\0\x06"
      "DEALER"s;
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

inline posix::Descriptor connect_and_send(const std::string& endpoint, const std::string& bytes) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port =
      htons(static_cast<std::uint16_t>(std::stoi(endpoint.substr(endpoint.rfind(':') + 1))));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  posix::Descriptor client(::socket(AF_INET, SOCK_STREAM, 0));
  EXPECT_EQ(::connect(client.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address),
            0);
  EXPECT_EQ(::send(client.number(), bytes.data(), bytes.size(), 0),
            static_cast<ssize_t>(bytes.size()));
  return client;
}

}  // namespace ziggurat::network
