// SPDX-License-Identifier: MIT
// Time that the server gives to others than controllers and supervisors: much of the idle time, and
// a small share of the ticks'.

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "network/local_server.h"
#include "network/one_peer.h"
#include "network/raw_client.h"
#include "network/small_run.h"
#include "network/socket.h"
#include "ziggurat/ziggurat.h"

namespace ziggurat::network {
namespace {

using namespace std::string_literals;
using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

/// A socket with connections that have said their name.
struct Crowd {
  posix::Descriptor join(const std::string& name, Standing standing) {
    posix::Descriptor client = connect_and_send(socket.endpoints().front(), greeting_and(1, name));
    while (!socket.receive(received)) socket.poll(patience.timeout, {});
    EXPECT_EQ(received.bytes, name);
    if (standing != Standing::none) socket.set_standing(received.connection, standing, mebibyte);
    socket.handled();
    return client;
  }
  /// Takes messages until there were enough. @returns how many of each size
  template <class Enough>
  std::vector<int> take_until(Enough enough) {
    std::vector<int> taken(4);
    const auto end = Clock::now() + patience.timeout;
    while (!enough(taken) && Clock::now() < end) {
      if (socket.receive(received)) {
        ++taken.at(received.bytes.size());
        socket.handled();
      } else {
        socket.poll(milliseconds{1}, {});
      }
    }
    return taken;
  }
  Socket socket{local_config()};
  Received received;
};

void say(const posix::Descriptor& client, const std::string& bytes) {
  ASSERT_EQ(::send(client.number(), bytes.data(), bytes.size(), MSG_DONTWAIT),
            static_cast<ssize_t>(bytes.size()));
}

/// Until what was sent has arrived, on a busy machine, too.
void wait() { std::this_thread::sleep_for(milliseconds{200}); }

std::string repeated(int count, const std::string& frame) {
  std::string all;
  for (int i = 0; i < count; ++i) all += frame;
  return all;
}

const std::string ping = "\x04\x07\x04PING\0\0"s, pong = "\x04\x05\x04PONG"s;
const std::string short_message = "\0\1x"s, longer_message = "\0\2xx"s;

/// Number of PINGs of one connection that are answered before the message of another that came
/// behind them.
std::size_t answered_before_other(Standing standing) {
  Crowd crowd;
  const posix::Descriptor busy = crowd.join("busy", standing),
                          other = crowd.join("other", Standing::controller);
  say(busy, repeated(5000, ping));
  say(other, short_message);
  wait();
  while (!crowd.socket.receive(crowd.received)) crowd.socket.poll(patience.timeout, {});
  std::string heard(100'000, '\0');
  std::size_t size = 0;
  for (ssize_t part; (part = ::recv(busy.number(), heard.data() + size, heard.size() - size,
                                    MSG_DONTWAIT)) > 0;) {
    size += static_cast<std::size_t>(part);
  }
  return size / pong.size();
}

/// All at the front were answered at once, each with a send of its own.
TEST(Others, CommandsOfOneConnectionLetOthersThroughAfterAFew) {
  EXPECT_LE(answered_before_other(Standing::none), 100U);
  EXPECT_LE(answered_before_other(Standing::controller), 100U);
}

TEST(Others, HaveMuchOfTheTimeInWhichNoControllerWaits) {
  Crowd crowd;
  const posix::Descriptor controller = crowd.join("controller", Standing::controller);
  const posix::Descriptor other = crowd.join("other", Standing::none);
  constexpr int many = 2'000;
  say(other, repeated(many, short_message));
  crowd.socket.set_ticking(true);
  const auto begin = Clock::now();
  crowd.take_until([](const auto& taken) { return taken[1] == many; });
  const std::chrono::duration<double> wall = Clock::now() - begin,
                                      limited = many * least_cost / share_of_others;
  EXPECT_LT(wall.count(), limited.count() / 5);
}

TEST(Others, HaveASmallShareWhileControllersWait) {
  Crowd crowd;
  const posix::Descriptor controller = crowd.join("controller", Standing::controller);
  const posix::Descriptor supervisor = crowd.join("supervisor", Standing::supervisor);
  const posix::Descriptor other = crowd.join("other", Standing::observer);
  constexpr int many = 30'000, of_other = 10'000;
  say(controller, repeated(many, short_message));
  say(supervisor, repeated(many, longer_message));
  say(other, repeated(of_other, "\0\3xxx"s));
  wait();
  crowd.socket.set_ticking(true);
  const auto begin = Clock::now();
  const std::vector<int> limited =
      crowd.take_until([](const auto& taken) { return taken[1] + taken[2] == 2 * many; });
  const std::chrono::duration<double> wall = Clock::now() - begin, cost = least_cost;
  EXPECT_EQ(limited[1] + limited[2], 2 * many) << "a supervisor is not limited";
  EXPECT_GE(limited[3], 1) << "they are not kept out";
  EXPECT_LE(limited[3],
            (std::chrono::duration<double>(saved_share) + wall * share_of_others) / cost + 20);
  crowd.socket.set_ticking(false);
  const auto rest = of_other - limited[3];
  EXPECT_EQ(crowd.take_until([&](const auto& taken) { return taken[3] == rest; })[3], rest);
}

/// The reset of an environment took a hundred times as long as its work: the tick was open because
/// the program that asked had not answered it yet.
TEST(Others, WhoOwesTheCommandIsAnsweredAtOnce) {
  for (const v1::Role role : {v1::ROLE_SUPERVISOR, v1::ROLE_OBSERVER}) {
    const SmallRun small(1);
    Server server(local_config(), small.run());
    const std::string endpoint = server.endpoints().front();
    constexpr int many = 100;
    constexpr milliseconds work{1};
    bool is_over = false;
    std::thread client([&] {
      Options options;
      options.endpoint = endpoint;
      options.robots = {"*"};
      ziggurat::Session session(options);
      session.next();
      Peer peer({endpoint});
      v1::ClientMessage hello, status;
      hello.mutable_hello()->mutable_version()->set_major(1);
      hello.mutable_hello()->set_role(role);
      status.mutable_request()->mutable_status();
      peer.say(hello);
      EXPECT_TRUE(peer.hear().has_welcome());
      for (int i = 0; i < many; ++i) {
        peer.say(status);
        while (!peer.hear().has_response()) {
        }
      }
      session.next();
    });
    const auto answer_calls = [&] {
      for (const Call& call : server.take_calls()) {
        const auto end = Clock::now() + work;
        while (Clock::now() < end) {
        }
        server.answer(call, [&](wire::Outbox& outbox) { outbox.response(call.request.id, 0); });
      }
    };
    while (server.gather(patience) != Outcome::complete) answer_calls();
    world::Commands commands = small.commands();
    const world::Observations seen = small.observations(0);
    server.publish(seen, no_tags);
    const auto begin = Clock::now();
    while (!is_over) {
      is_over = server.collect(commands, patience) == Outcome::complete;
      answer_calls();
    }
    const std::chrono::duration<double> wall = Clock::now() - begin;
    server.finish({});
    while (server.drain(patience) != Outcome::complete) {
    }
    client.join();
    const double share = std::chrono::duration<double>(many * work).count() / share_of_others;
    EXPECT_LT(wall.count(), share / 10) << "role " << role;
  }
}

}  // namespace
}  // namespace ziggurat::network
