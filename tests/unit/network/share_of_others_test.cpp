// What observers cost the thread of the ticks, in its own processor time: what else the machine does
// makes no difference.

#include <gtest/gtest.h>

#include <atomic>
#include <cstdio>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "network/limits.h"
#include "network/local_server.h"
#include "network/one_peer.h"
#include "network/small_run.h"
#include "network/time_share.h"
#include "ziggurat/ziggurat.h"

namespace ziggurat::network {
namespace {

using std::chrono::milliseconds;

/// Asks again as often as it is answered, with many requests on their way.
void flood(const std::string& endpoint, const std::atomic<bool>& is_over, std::atomic<int>& answers) {
  Peer peer({endpoint});
  v1::ClientMessage hello, read;
  hello.mutable_hello()->mutable_version()->set_major(1);
  hello.mutable_hello()->set_role(v1::ROLE_OBSERVER);
  read.mutable_request()->mutable_read()->add_entities("*");
  peer.say(hello);
  EXPECT_TRUE(peer.hear().has_welcome());
  for (int i = 0; i < 50; ++i) peer.say(read);
  while (!is_over) {
    if (!peer.hear().has_response()) continue;
    ++answers;
    peer.say(read);
  }
}

void answer_calls(Server& server) {
  for (const Call& call : server.take_calls()) {
    server.answer_question(call, [](wire::Outbox& outbox) { outbox.response(0, 0); });
  }
}

TEST(ShareOfOthers, ObserversThatAskAsFastAsTheyCanTakeLittleOfTheThreadOfTheTicks) {
  const SmallRun small(1);
  Config config = local_config();
  config.rate = {1e9, 1e9};
  Server server(config, small.run());
  const std::string endpoint = server.endpoints().front();
  std::atomic<bool> is_over = false;
  std::atomic<int> answers = 0, ended = 0;
  std::vector<std::thread> clients;
  for (int i = 0; i < 4; ++i) {
    clients.emplace_back([&] {
      flood(endpoint, is_over, answers);
      ++ended;
    });
  }
  clients.emplace_back([&] {  // owes its answer all the time
    Options options;
    options.endpoint = endpoint;
    options.robots = {"*"};
    ziggurat::Session session(options);
    session.next();
    is_over.wait(false);
    ++ended;
  });
  while (server.gather(patience) != Outcome::complete) answer_calls(server);
  world::Commands commands = small.commands();
  const world::Observations seen = small.observations(0);
  server.publish(seen, no_tags);
  const auto serve = [&](auto is_enough) {
    while (!is_enough()) {
      server.collect(commands, {milliseconds{50}, {}});
      answer_calls(server);
    }
  };
  const auto begin = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  serve([&] { return answers > 100; });  // all are there
  const double first = seconds();
  const auto used_before = ThreadClock::now();
  const int answers_before = answers;
  serve([&] { return seconds() > first + 3; });
  const double used = std::chrono::duration<double>(ThreadClock::now() - used_before).count();
  const double wall = seconds() - first;
  const int answered = answers - answers_before;
  is_over = true;
  is_over.notify_all();
  serve([&] { return ended == 5; });
  for (std::thread& client : clients) client.join();
  std::printf("%.2f %% of the time for %d answers\n", 100 * used / wall, answered);
  EXPECT_LT(used, 0.05 * wall) << answered << " answers";
  EXPECT_GT(answered, 100);
  const double most = wall * share_of_others / std::chrono::duration<double>(least_cost).count();
  EXPECT_LT(answered, 1.2 * most + 200);
}

/// A client that comes to drive a free robot is one of the others until then, so they have no small
/// share of the time while the tick waits for one.
TEST(ShareOfOthers, IsNotLimitedWhileTheTickWaitsForAFreeRobot) {
  const SmallRun small(1);
  Config config = local_config();
  config.rate = {1e9, 1e9};
  Server server(config, small.run());
  const std::string endpoint = server.endpoints().front();
  world::Commands commands = small.commands();
  std::optional<Peer> driver(std::in_place, std::vector{endpoint});
  v1::ClientMessage hello;
  hello.mutable_hello()->mutable_version()->set_major(1);
  hello.mutable_hello()->set_role(v1::ROLE_CONTROLLER);
  hello.mutable_hello()->add_robots("*");
  driver->say(hello);
  ASSERT_EQ(server.gather(patience), Outcome::complete);
  const world::Observations seen = small.observations(0);
  server.publish(seen, no_tags);
  driver.reset();  // its connection is gone
  std::atomic<bool> is_over = false, has_ended = false;
  std::atomic<int> answers = 0;
  std::thread client([&] {
    flood(endpoint, is_over, answers);
    has_ended = true;
  });
  const auto serve = [&](auto is_enough) {
    while (!is_enough()) {
      server.collect(commands, {milliseconds{50}, {}});
      answer_calls(server);
    }
  };
  const auto is_free = [&] {
    return server.status().front().membership == RobotStatus::Membership::free;
  };
  serve(is_free);
  const auto begin = std::chrono::steady_clock::now();
  constexpr int many = 5000;
  const int before = answers;
  serve([&] { return answers >= before + many; });
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  is_over = true;
  serve([&] { return has_ended.load(); });
  client.join();
  std::printf("%d answers in %.2f s\n", many, wall.count());
  const double least = many * std::chrono::duration<double>(least_cost).count() / share_of_others;
  EXPECT_LT(wall.count(), 0.8 * least);
}

}  // namespace
}  // namespace ziggurat::network
