// SPDX-License-Identifier: MIT
#pragma once
// The client's end of CURVE (RFC 26), step by step, so that tests can send steps again, in another
// order or altered. The mathematics is libsodium's.

#include <gtest/gtest.h>
#include <sodium.h>

#include <array>
#include <cstdint>
#include <string>

#include "network/zmtp/curve.h"
#include "zmtp/frame.h"

namespace ziggurat::network::zmtp {

class CurveClient {
 public:
  struct Pair {
    Key open, secret;
  };
  static Pair make_pair() {
    Pair pair;
    ::crypto_box_keypair(pair.open.data(), pair.secret.data());
    return pair;
  }

  CurveClient(const Pair& own, const Key& server) : own_(own), server_(server) {}

  /// @param number  of the box
  std::string hello(std::uint64_t number = 1, const std::string& version = {1, 0}) const {
    return framed("HELLO", version + std::string(72, '\0') + text(transient_.open) + bytes(number) +
                               box(std::string(64, '\0'), "CurveZMQHELLO---" + bytes(number),
                                   server_, transient_.secret));
  }

  /// The server's WELCOME has the cookie and the server's transient key.
  void take_welcome(const std::string& frame) {
    const std::string nonce = "WELCOME-" + frame.substr(10, 16), sealed = frame.substr(26);
    ASSERT_EQ(sealed.size(), 144U);
    std::array<std::uint8_t, 128> content;
    ASSERT_EQ(::crypto_box_open_easy(content.data(), start(sealed), sealed.size(), start(nonce),
                                     server_.data(), transient_.secret.data()),
              0);
    std::copy_n(content.begin(), 32, server_transient_.begin());
    cookie_.assign(content.begin() + 32, content.end());
  }

  std::string initiate(std::uint64_t number = 2) const {
    const std::string nonce(16, 'n');
    const std::string vouch = box(text(transient_.open) + text(server_), "VOUCH---" + nonce,
                                  server_transient_, own_.secret);
    const std::string content = text(own_.open) + nonce + vouch + metadata_of("DEALER");
    return framed("INITIATE", cookie_ + bytes(number) +
                                  box(content, "CurveZMQINITIATE" + bytes(number),
                                      server_transient_, transient_.secret));
  }

  /// The body of a MESSAGE. @param content  with its byte of flags
  std::string message(std::uint64_t number, const std::string& content,
                      const std::string& direction = "CurveZMQMESSAGEC") const {
    return "\x07MESSAGE" + bytes(number) +
           box(content, direction + bytes(number), server_transient_, transient_.secret);
  }
  /// A frame with that body.
  static std::string frame(const std::string& body, std::uint8_t flags = 0) {
    std::array<std::uint8_t, longest_header> header;
    write_header(body.size(), header.data());
    header[0] |= flags;
    return std::string(text_of({header.data(), header_length(body.size())})) + body;
  }

  static std::string bytes(std::uint64_t number) {
    std::string bytes(8, '\0');
    for (std::size_t i = 8; i-- > 0; number >>= 8) bytes[i] = static_cast<char>(number);
    return bytes;
  }

  Pair transient_ = make_pair();
  std::string cookie_;

 private:
  static const std::uint8_t* start(const std::string& text) {
    return reinterpret_cast<const std::uint8_t*>(text.data());
  }
  static std::string text(const Key& key) { return {key.begin(), key.end()}; }
  static std::string framed(const std::string& name, const std::string& data) {
    std::string frame;
    append_command(frame, name, data);
    return frame;
  }
  static std::string box(const std::string& content, const std::string& nonce, const Key& theirs,
                         const Key& ours) {
    std::string sealed(content.size() + 16, '\0');
    EXPECT_EQ(nonce.size(), 24U);
    EXPECT_EQ(::crypto_box_easy(reinterpret_cast<std::uint8_t*>(sealed.data()), start(content),
                                content.size(), start(nonce), theirs.data(), ours.data()),
              0);
    return sealed;
  }

  Pair own_;
  Key server_, server_transient_ = make_pair().open;  // until the WELCOME, any
};

}  // namespace ziggurat::network::zmtp
