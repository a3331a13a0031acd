// How long connections may be there without session.

#include <gtest/gtest.h>
#include <sys/socket.h>

#include "network/peer_table.h"
#include "network/raw_client.h"

namespace ziggurat::network {
namespace {

using std::chrono::seconds;

struct Pair {
  Descriptor ours, theirs;
};

Pair connected() {
  int ends[2];
  EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends), 0);
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

/// The table with one more connection.
/// @returns the client's end
Descriptor connect(PeerTable& table, bool is_trusted, Time now) {
  Pair pair = connected();
  table.add(std::move(pair.ours), nullptr, is_trusted, now);
  return std::move(pair.theirs);
}

void shake_hands(PeerTable& table, std::uint64_t id, const Descriptor& client) {
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
  const Descriptor silent = connect(table, false, start), own = connect(table, true, start),
                   open = connect(table, false, start);
  shake_hands(table, PeerTable::first_id + 3, open);
  EXPECT_EQ(left_at(table, start + seconds{10}), 3u);
  EXPECT_EQ(left_at(table, start + seconds{11}), 2u) << "its handshake is not over";
  EXPECT_EQ(left_at(table, start + seconds{60}), 2u);
  EXPECT_EQ(left_at(table, start + seconds{61}), 1u);
  EXPECT_EQ(left_at(table, start + seconds{3600}), 1u) << "processes of this user have time";
  EXPECT_EQ(table.without_session(), 1u);
}

TEST(PeerTable, ThoseWithSessionStay) {
  const Time start = std::chrono::steady_clock::now();
  PeerTable table;
  const Descriptor client = connect(table, false, start);
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

}  // namespace
}  // namespace ziggurat::network
