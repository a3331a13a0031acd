// What observers cost the thread of the ticks, in its own processor time: what else the machine does
// makes no difference.

#include <gtest/gtest.h>

#include <atomic>
#include <cstdio>
#include <thread>

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
    while (!is_over) std::this_thread::sleep_for(milliseconds{10});
    ++ended;
  });
  ASSERT_EQ(server.gather(patience), Outcome::complete);
  world::Commands commands = small.commands();
  const world::Observations seen = small.observations(0);
  server.publish(seen, no_tags);
  const auto serve = [&](auto is_enough) {
    while (!is_enough()) {
      server.collect(commands, {milliseconds{50}, {}});
      for (const Call& call : server.take_calls()) {
        server.answer_question(call, [](wire::Outbox& outbox) { outbox.response(0, 0); });
      }
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
  serve([&] { return ended == 5; });
  for (std::thread& client : clients) client.join();
  std::printf("%.2f %% of the time for %d answers\n", 100 * used / wall, answered);
  EXPECT_LT(used, 0.05 * wall) << answered << " answers";
  EXPECT_GT(answered, 100);
  const double most = wall * share_of_others / std::chrono::duration<double>(least_cost).count();
  EXPECT_LT(answered, 1.2 * most + 200);
}

}  // namespace
}  // namespace ziggurat::network
