// SPDX-License-Identifier: MIT
// In which order connections get their messages taken.

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "network/local_server.h"
#include "network/raw_client.h"
#include "network/socket.h"

namespace ziggurat::network {
namespace {

using namespace std::string_literals;

TEST(Turns, AConnectionThatSendsMuchDoesNotKeepOthersWaiting) {
  constexpr int many = 500;
  Socket socket(local_config());
  const std::string endpoint = socket.endpoints().front();
  const posix::Descriptor busy = connect_and_send(endpoint, greeting_and(many, "busy"));
  const posix::Descriptor other = connect_and_send(endpoint, greeting_and(1, "other"));
  const posix::Descriptor third = connect_and_send(endpoint, greeting_and(1, "third"));
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

/// Each was counted as a message: who asks now and then waited for its turn although no other
/// client asked.
TEST(Turns, LooksAtOthersWhereNothingIsTakeNoneOfTheirTime) {
  Socket socket(local_config());
  socket.set_ticking(true);
  Received received;
  for (int i = 0; i < 10'000; ++i) EXPECT_FALSE(socket.receive(received));
  const posix::Descriptor other =
      connect_and_send(socket.endpoints().front(), greeting_and(1, "question"));
  bool is_taken = false;
  for (int look = 0; look < 10 && !is_taken; ++look) is_taken = socket.receive(received);
  ASSERT_TRUE(is_taken) << "without waiting";
  EXPECT_EQ(received.bytes, "question");
}

/// Commands of ZeroMQ's protocol are no messages: they are read without end if nothing bounds it.
TEST(Turns, AConnectionThatSendsCommandsWithoutEndDoesNotKeepOthersWaiting) {
  Socket socket(local_config());
  const std::string endpoint = socket.endpoints().front();
  const posix::Descriptor busy = connect_and_send(endpoint, greeting_and(0, ""));
  std::atomic<bool> is_over = false;
  std::thread sender([&] {
    std::string commands;
    while (commands.size() < 1'000'000) commands += "\x04\x05\x04NONE"s;
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds{10};
    while (!is_over && std::chrono::steady_clock::now() < end) {
      // Whole ones: the connection would be over otherwise.
      std::string_view rest = commands;
      while (!rest.empty()) {
        const ssize_t size = ::send(busy.number(), rest.data(), rest.size(), MSG_NOSIGNAL);
        if (size < 0) break;
        rest.remove_prefix(static_cast<std::size_t>(size));
      }
    }
    is_over = true;
  });
  Received received;
  for (int i = 0; i < 20; ++i) {
    socket.poll(std::chrono::milliseconds{10}, {});
    socket.receive(received);
  }
  const posix::Descriptor other = connect_and_send(endpoint, greeting_and(1, "other"));
  bool is_taken = false;
  while (!is_taken && !is_over) {
    socket.poll(patience.timeout, {});
    is_taken = socket.receive(received);
  }
  EXPECT_TRUE(is_taken) << "before the sender ended";
  is_over = true;
  ::shutdown(busy.number(), SHUT_RDWR);
  sender.join();
}

TEST(Turns, OtherDescriptorsAreLookedAtWhileMessagesWait) {
  Socket socket(local_config());
  const posix::Descriptor busy =
      connect_and_send(socket.endpoints().front(), greeting_and(100, "busy"));
  Received received;
  while (!socket.receive(received)) socket.poll(patience.timeout, {});
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const posix::Descriptor reader(ends[0]), writer(ends[1]);
  EXPECT_EQ(socket.poll(patience.timeout, std::array{reader.number()}), Socket::Ready::message);
  ASSERT_EQ(::write(writer.number(), "x", 1), 1);
  EXPECT_EQ(socket.poll(patience.timeout, std::array{reader.number()}), Socket::Ready::woken);
}

/// Processes of this user can connect even if others without session have all places, and their
/// entrance is closed.
TEST(Turns, ThePrivateEntranceStaysOpenWhenOthersHaveAllPlaces) {
  rlimit usual{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &usual), 0);
  const rlimit few{256, usual.rlim_max};  // so many descriptors make 104 places
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &few), 0);
  Config config = local_config();
  Socket socket(config);
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &usual), 0);
  std::vector<posix::Descriptor> others;
  for (int i = 0; i < 110; ++i) {
    others.push_back(connect_and_send(socket.endpoints().front(), greeting_and(0, "")));
  }
  Received received;
  const auto serve = [&] {
    for (int i = 0; i < 20; ++i) {
      socket.poll(std::chrono::milliseconds{1}, {});
      EXPECT_FALSE(socket.receive(received));
    }
  };
  serve();
  const std::string name = "ziggurat-turns-" + std::to_string(::getpid());
  config.private_endpoint = "ipc://@" + name;
  socket.add_private(config);
  serve();
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  name.copy(address.sun_path + 1, name.size());
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  const posix::Descriptor own(::socket(AF_UNIX, SOCK_STREAM, 0));
  ASSERT_EQ(::connect(own.number(), reinterpret_cast<const sockaddr*>(&address), size), 0);
  const std::string bytes = greeting_and(1, "own");
  ASSERT_EQ(::send(own.number(), bytes.data(), bytes.size(), 0),
            static_cast<ssize_t>(bytes.size()));
  bool is_taken = false;
  for (int i = 0; i < 100 && !is_taken; ++i) {
    socket.poll(std::chrono::milliseconds{10}, {});
    is_taken = socket.receive(received);
  }
  ASSERT_TRUE(is_taken);
  EXPECT_EQ(received.bytes, "own");
}

}  // namespace
}  // namespace ziggurat::network
