// SPDX-License-Identifier: MIT
// Age limits of connections without session, and the memory limits of all connections.

#include "network/peer_table.h"

#include <gtest/gtest.h>
#include <malloc.h>
#include <sys/socket.h>

#include <cstring>
#include <vector>

#include "network/raw_client.h"

namespace ziggurat::network {
namespace {

using std::chrono::seconds;

struct Pair {
  posix::Descriptor ours, theirs;
};

Pair connected() {
  int ends[2];
  EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends), 0);
  return {posix::Descriptor(ends[0]), posix::Descriptor(ends[1])};
}

/// The table with one more connection.
/// @returns the client's end
posix::Descriptor connect(PeerTable& table, Trust trust, Time now) {
  Pair pair = connected();
  table.add(std::move(pair.ours), nullptr, trust, now);
  return std::move(pair.theirs);
}

void shake_hands(PeerTable& table, std::uint64_t id, const posix::Descriptor& client) {
  const std::string bytes = greeting_and(0, "");
  ASSERT_EQ(::send(client.number(), bytes.data(), bytes.size(), 0),
            static_cast<ssize_t>(bytes.size()));
  Received received;
  table.act(*table.find(id), [&](PeerSocket& peer) {
    peer.read();
    EXPECT_FALSE(peer.next(longest_without_session, received));
  });
  ASSERT_TRUE(table.find(id)->is_open());
}

std::size_t left_at(PeerTable& table, Time time) {
  table.end_old(time);
  table.remove_ended();
  return table.size();
}

TEST(PeerTable, ConnectionsWithoutSessionGrowOld) {
  const Time start = std::chrono::steady_clock::now();
  PeerTable table;
  const posix::Descriptor silent = connect(table, Trust::none, start),
                          own = connect(table, Trust::own_user, start),
                          open = connect(table, Trust::none, start);
  shake_hands(table, PeerTable::first_id + 3, open);
  EXPECT_EQ(left_at(table, start + seconds{10}), 3u);
  EXPECT_EQ(left_at(table, start + seconds{11}), 2u) << "its handshake is not over";
  EXPECT_EQ(left_at(table, start + seconds{60}), 2u);
  EXPECT_EQ(left_at(table, start + seconds{61}), 1u);
  EXPECT_EQ(left_at(table, start + seconds{3600}), 1u) << "processes of this user have time";
  EXPECT_EQ(table.without_session(), 1u);
}

TEST(PeerTable, TheOldestWhoseHandshakeIsNotOverMakesPlaceAfterASecond) {
  using std::chrono::milliseconds;
  const Time start = std::chrono::steady_clock::now();
  PeerTable table;
  const posix::Descriptor open = connect(table, Trust::none, start),
                          silent = connect(table, Trust::none, start),
                          later = connect(table, Trust::none, start + milliseconds{500});
  shake_hands(table, PeerTable::first_id + 1, open);
  const auto has = [&](std::uint64_t number) {
    return table.find(PeerTable::first_id + number) != nullptr;
  };
  EXPECT_FALSE(table.make_place(start + milliseconds{999}));
  EXPECT_TRUE(table.make_place(start + seconds{1}));
  EXPECT_TRUE(has(1) && !has(2) && has(3));
  EXPECT_FALSE(table.make_place(start + milliseconds{1499})) << "it has a second for its handshake";
  EXPECT_TRUE(table.make_place(start + milliseconds{1500}));
  EXPECT_TRUE(has(1) && !has(3));
  EXPECT_TRUE(table.make_place(start + milliseconds{1500}))
      << "none is left but that whose handshake is over";
}

TEST(PeerTable, ThoseWithSessionStay) {
  const Time start = std::chrono::steady_clock::now();
  PeerTable table;
  const posix::Descriptor client = connect(table, Trust::none, start);
  shake_hands(table, PeerTable::first_id + 1, client);
  const std::string name = table.find(PeerTable::first_id + 1)->name();
  table.set_standing(name, Standing::observer, longest_without_session, start);
  EXPECT_EQ(left_at(table, start + seconds{3600}), 1u);
  EXPECT_EQ(table.without_session(), 0u);
  EXPECT_FALSE(table.make_place(start + seconds{3600})) << "none is without session";
  table.set_standing(name, Standing::none, longest_without_session, start + seconds{3600});
  EXPECT_EQ(left_at(table, start + seconds{3660}), 1u);
  EXPECT_EQ(left_at(table, start + seconds{3661}), 0u);
}

/// Connections with a finished handshake.
struct Crowd {
  Crowd(const Shared& most, std::uint64_t count, Trust trust) : table(most) {
    const Time now = std::chrono::steady_clock::now();
    for (std::uint64_t i = 1; i <= count; ++i) {
      clients.push_back(connect(table, trust, now));
      shake_hands(table, PeerTable::first_id + i, clients.back());
    }
  }
  PeerSocket* peer(std::uint64_t index) { return table.find(PeerTable::first_id + 1 + index); }
  /// Sends a message to a client that does not read.
  void tell(std::uint64_t index, std::size_t size) {
    Buffer frame;
    const std::size_t at = peer(index)->content_at(size);
    frame.reserve(at + size);
    std::memset(frame.bytes.get(), 0, at + size);
    table.act(*peer(index), [&](PeerSocket& to) { to.send(frame, size, MessageKind::other); });
  }
  /// The client sends so much of a long message.
  void hear_part(std::uint64_t index, std::size_t size) {
    using namespace std::string_literals;
    const std::string header = "\2\0\0\0\0\4\0\0\0"s;  // of 64 MiB
    ASSERT_EQ(::send(clients[index].number(), header.data(), header.size(), 0), 9);
    const std::string part(kibibyte, 'x');
    Received received;
    for (std::size_t sent = 0; sent < size && peer(index) != nullptr; sent += part.size()) {
      ASSERT_EQ(::send(clients[index].number(), part.data(), part.size(), 0), 1024);
      table.act(*peer(index), [&](PeerSocket& from) {
        from.read();
        EXPECT_FALSE(from.next(64 * mebibyte, received));
      });
    }
  }
  PeerTable table;
  std::vector<posix::Descriptor> clients;
};

TEST(PeerTable, OneThatDoesNotReadIsDisconnectedWithANotice) {
  Crowd crowd({}, 1, Trust::none);
  for (int i = 0; i < 100 && crowd.peer(0) != nullptr; ++i) crowd.tell(0, 100'000);
  EXPECT_EQ(crowd.peer(0), nullptr);
  const auto notices = crowd.table.take_notices(std::chrono::steady_clock::now());
  ASSERT_EQ(notices.size(), 1u);
  EXPECT_EQ(notices[0], "A client was disconnected because it does not read what it is sent.");
}

TEST(PeerTable, WhatWaitsForAllIsBoundedAndTheOneForWhichMostWaitsIsDisconnected) {
  EXPECT_EQ(Shared{}.waiting, 256 * mebibyte) << "docs/protocol.md, K5";
  Crowd crowd({.waiting = 3 * mebibyte}, 3, Trust::none);
  for (int i = 0; i < 5; ++i) {
    for (const std::uint64_t index : {0, 1, 2})
      crowd.tell(index, (index == 1 ? 300 : 200) * kibibyte);
  }
  EXPECT_EQ(crowd.peer(1), nullptr);
  EXPECT_NE(crowd.peer(0), nullptr);
  EXPECT_NE(crowd.peer(2), nullptr);
  const auto notices = crowd.table.take_notices(std::chrono::steady_clock::now());
  ASSERT_EQ(notices.size(), 1u);
  EXPECT_EQ(notices[0],
            "A client was disconnected because too much waits for clients that do not read.");
}

/// Many end before the table is asked to forget them.
TEST(PeerTable, WhatWaitedForOneThatIsDisconnectedGoesAtOnce) {
  constexpr std::uint64_t many = 30;
  Crowd crowd({}, many, Trust::none);
  const auto allocated = [] { return ::mallinfo2().uordblks + ::mallinfo2().hblkhd; };
  const std::size_t before = allocated();
  for (std::uint64_t index = 0; index < many; ++index) {
    while (crowd.peer(index) != nullptr) crowd.tell(index, 100'000);
  }
  EXPECT_LT(allocated() - before, 5 * mebibyte);
}

TEST(PeerTable, UnfinishedMessagesOfAllAreBounded) {
  EXPECT_EQ(Shared{}.unfinished, 512 * mebibyte) << "docs/protocol.md, K5";
  Crowd crowd({.unfinished = 8 * mebibyte}, 4, Trust::own_user);
  crowd.hear_part(3, 500 * kibibyte);
  for (std::uint64_t index = 0; index < 3; ++index) crowd.hear_part(index, 3000 * kibibyte);
  std::size_t taken = 0;
  for (std::uint64_t index = 0; index < 4; ++index) {
    taken += crowd.peer(index) == nullptr ? 0 : crowd.peer(index)->unfinished_bytes();
  }
  EXPECT_LE(taken, 8 * mebibyte);
  EXPECT_NE(crowd.peer(0), nullptr);
  EXPECT_EQ(crowd.peer(2), nullptr) << "its message grew when there was no place";
  EXPECT_NE(crowd.peer(3), nullptr);
  const auto notices = crowd.table.take_notices(std::chrono::steady_clock::now());
  ASSERT_FALSE(notices.empty());
  EXPECT_EQ(notices[0],
            "A client was disconnected: too much of clients' messages has arrived in part.");
}

}  // namespace
}  // namespace ziggurat::network
