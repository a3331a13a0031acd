// SPDX-License-Identifier: MIT
// One connection over a socket pair: what is cut into messages, and what may wait.

#include "network/peer_socket.h"

#include <gtest/gtest.h>
#include <malloc.h>
#include <sys/socket.h>

#include <cstring>
#include <memory>
#include <string>
#include <vector>

namespace ziggurat::network {
namespace {

struct Connected {
  Connected() {
    int ends[2];
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends), 0);
    client = posix::Descriptor(ends[0]);
    peer = std::make_unique<PeerSocket>("peer", posix::Descriptor(ends[1]), nullptr, Trust::none,
                                        Time{});
  }
  void say(const std::string& bytes) {
    ASSERT_EQ(::send(client.number(), bytes.data(), bytes.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(bytes.size()));
    peer->read();
  }
  /// All that has come for the client.
  std::string hear() {
    std::string heard, part(1 << 20, '\0');
    for (;;) {
      peer->flush();
      const ssize_t size = ::recv(client.number(), part.data(), part.size(), 0);
      if (size <= 0) return heard;
      heard.append(part, 0, static_cast<std::size_t>(size));
    }
  }
  static std::string greeting(const std::string& mechanism = "NULL") {
    std::string text = std::string("\xff\0\0\0\0\0\0\0\1\x7f\3\1", 12) + mechanism;
    text.resize(64);
    return text;
  }
  static std::string frame(char flags, const std::string& body) {
    return std::string{flags, static_cast<char>(body.size())} + body;
  }
  static std::string ready(const std::string& type) {
    using namespace std::string_literals;
    return frame(4, "\x05READY\x0bSocket-Type\0\0\0"s + static_cast<char>(type.size()) + type);
  }
  static std::string long_header(std::uint64_t size) {
    std::string text = "\2";
    for (int i = 7; i >= 0; --i) text += static_cast<char>(size >> (8 * i));
    return text;
  }
  bool next(std::size_t limit = 1000) { return peer->next(limit, received); }
  void open() {
    say(greeting() + ready("DEALER"));
    EXPECT_FALSE(next());
    ASSERT_TRUE(peer->is_open());
    hear();
  }
  void tell(std::size_t size, MessageKind kind, char fill) {
    Buffer buffer;
    const std::size_t at = peer->content_at(size);
    buffer.reserve(at + size);
    std::memset(buffer.bytes.get() + at, fill, size);
    peer->send(buffer, size, kind);
  }

  posix::Descriptor client;
  std::unique_ptr<PeerSocket> peer;
  Received received;
};

struct PeerSocketTest : Connected, ::testing::Test {};

TEST_F(PeerSocketTest, OtherProtocolsEndTheConnection) {
  for (const std::string& text :
       {std::string("GET / HTTP/1.1\r\n"), std::string(64, '\0'), greeting("PLAIN"),
        greeting() + ready("PUB"), greeting() + frame(0x44, ""), greeting() + frame(4, "\x05HELLO"),
        greeting() + long_header(5000)}) {
    Connected fresh;
    fresh.say(text);
    EXPECT_FALSE(fresh.next());
    EXPECT_TRUE(fresh.peer->is_over()) << text;
  }
}

TEST_F(PeerSocketTest, TheLastMessageIsReadThoughTheClientHasClosed) {
  open();
  const std::string last = frame(0, "last words");
  ASSERT_EQ(::send(client.number(), last.data(), last.size(), 0),
            static_cast<ssize_t>(last.size()));
  client = {};
  tell(10, MessageKind::other, 'x');
  tell(10, MessageKind::observation, 'y');
  EXPECT_FALSE(peer->is_over());
  peer->read();
  ASSERT_TRUE(next());
  EXPECT_EQ(received.bytes, "last words");
  EXPECT_FALSE(next());
  tell(10, MessageKind::other, 'z');
  EXPECT_TRUE(peer->is_over());
}

TEST_F(PeerSocketTest, MessagesAreCutFromAnyPieces) {
  const std::string all = greeting() + ready("DEALER") + frame(0, "one") + frame(1, "{two") +
                          frame(0, "three") + frame(4, std::string("\x04PING\0\0x", 8)) +
                          frame(0, "four");
  std::vector<std::string> heard;
  for (const char byte : all) {
    say({byte});
    while (next()) {
      heard.emplace_back(received.bytes);
      EXPECT_EQ(received.is_single_frame, heard.back() != "three");
      EXPECT_EQ(received.several_frames,
                heard.back() == "three" ? wire::Encoding::json : wire::Encoding::binary);
      EXPECT_EQ(received.connection, "peer");
    }
  }
  EXPECT_EQ(heard, (std::vector<std::string>{"one", "three", "four"}));
}

TEST_F(PeerSocketTest, APingIsAnswered) {
  open();
  say(frame(4, std::string("\x04PING\0\1abc", 10)));
  EXPECT_FALSE(next());
  EXPECT_EQ(hear(), frame(4, "\x04PONGabc"));
}

TEST_F(PeerSocketTest, WithoutSessionALongMessageEndsTheConnection) {
  open();
  say(long_header(1001));
  EXPECT_FALSE(next());
  EXPECT_TRUE(peer->is_over());
}

TEST_F(PeerSocketTest, WithASessionALongMessageIsToldAndNotKept) {
  open();
  peer->set_standing(Standing::observer, 64 * kibibyte, Time{});
  say(long_header(1500) + std::string(1500, 'x') + frame(0, "next"));
  ASSERT_TRUE(next());
  EXPECT_GE(received.skipped, 1500U);
  EXPECT_TRUE(received.bytes.empty());
  ASSERT_TRUE(next());
  EXPECT_EQ(received.bytes, "next");
  EXPECT_EQ(received.skipped, 0U);
  say(long_header(2100));
  EXPECT_FALSE(next());
  EXPECT_TRUE(peer->is_over());
}

TEST_F(PeerSocketTest, AnAnnouncedMessageTakesNoMemoryBeforeItArrives) {
  open();
  say(long_header(60 << 20) + "x");
  EXPECT_FALSE(next(64 << 20));
  peer->read();
  EXPECT_LT(peer->unfinished_bytes(), 64U * 1024);
}

TEST_F(PeerSocketTest, TheNewestObservationTakesThePlaceOfTheOneThatWaits) {
  open();
  peer->set_standing(Standing::controller, 64 * mebibyte, Time{});
  constexpr std::size_t size = 3 << 20;
  for (char tick = 0; tick < 100; ++tick) tell(size, MessageKind::observation, tick);
  tell(10, MessageKind::other, 'e');
  EXPECT_FALSE(peer->is_over());
  EXPECT_LT(peer->output().waiting_bytes(), 200U);
  const std::string heard = hear();
  EXPECT_EQ(heard.size(), 2 * (size + 9) + 12) << "the first, the last and the error";
  EXPECT_EQ(heard[100], 0);
  EXPECT_EQ(heard[size + 9 + 100], 99);
  EXPECT_EQ(heard.back(), 'e');
}

TEST_F(PeerSocketTest, OneThatDoesNotReadIsDisconnected) {
  open();
  int count = 0;
  while (!peer->is_over() && count < 1000) {
    tell(100'000, MessageKind::other, 'r');
    ++count;
    EXPECT_LE(peer->output().waiting_bytes(), most_waiting);
  }
  EXPECT_TRUE(peer->output().is_congested());
  EXPECT_LT(count, 60);
}

TEST_F(PeerSocketTest, MessagesBehindOneThatIsLongerThanWhatMayWaitAreKept) {
  open();
  peer->set_standing(Standing::controller, 64 * mebibyte, Time{});
  const std::size_t size = 2 * most_waiting;
  tell(size, MessageKind::other, 'l');
  tell(100, MessageKind::other, 'h');
  EXPECT_FALSE(peer->is_over());
  EXPECT_EQ(hear().size(), size + 9 + 102);
  tell(most_waiting - kibibyte, MessageKind::other, 'r');
  tell(size, MessageKind::other, 'l');
  EXPECT_TRUE(peer->output().is_congested()) << "something waited before it";
}

/// Small messages that wait take no memory that was for a large one.
TEST_F(PeerSocketTest, WhatWaitsTakesNoMoreMemoryThanItIsCountedFor) {
  open();
  peer->set_standing(Standing::observer, 64 * kibibyte, Time{});
  Buffer buffer;
  buffer.reserve(mebibyte);
  const std::size_t at = peer->content_at(20);
  const auto tell_20_bytes = [&] { peer->send(buffer, 20, MessageKind::other); };
  std::memset(buffer.bytes.get(), 0, at + 20);
  const std::size_t before = ::mallinfo2().uordblks + ::mallinfo2().hblkhd;
  int count = 0;
  for (; peer->output().waiting_bytes() < mebibyte && count < 1'000'000; ++count) tell_20_bytes();
  EXPECT_EQ(buffer.capacity, mebibyte) << "it is for the next message";
  EXPECT_LT(count, 1'000'000);
  EXPECT_LT(::mallinfo2().uordblks + ::mallinfo2().hblkhd - before, 2 * mebibyte);
}

TEST_F(PeerSocketTest, PingsOfOneThatDoesNotReadHaveAnEnd) {
  open();
  const std::string ping = frame(4, std::string("\x04PING\0\1", 7) + std::string(16, 'x'));
  for (int i = 0; i < 1'000'000 && !peer->is_over(); ++i) {
    say(ping);
    next();
  }
  EXPECT_TRUE(peer->is_over());
}

}  // namespace
}  // namespace ziggurat::network
