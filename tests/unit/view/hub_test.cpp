// SPDX-License-Identifier: MIT
// Viewers without sockets: what they send, and what waits for them.

#include "view/hub.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>

namespace ziggurat::view {
namespace {

using channels::Kind;

const channels::Schema schema{"ziggurat.v1.Poses", "descriptors"};

channels::Message message_of(std::uint32_t channel, const std::string& bytes) {
  return {channel, 5, std::make_shared<const channels::Content>(bytes)};
}

struct Bench {
  Bench() {
    hub.set_channels(
        {{1, "/world", Kind::world, &schema, 0}, {2, "/poses", Kind::poses, &schema, 0}});
  }
  void say(Viewer& viewer, const std::string& text) { hub.receive(viewer, text, Hub::Frame::text); }
  /// All that waits: operations of texts, contents of messages.
  std::vector<std::string> sent(Viewer& viewer) {
    std::vector<std::string> all;
    while (auto item = hub.next(viewer)) {
      if (item->is_text)
        all.push_back(nlohmann::json::parse(item->head).at("op"));
      else if (item->content)
        all.push_back(item->content->bytes());
    }
    return all;
  }
  ViewerRequests requests;
  Hub hub{
      {"1", "s", "id", false}, {{"real_time_factor", 1.0}, {"phase", std::string("x")}}, requests};
};

using Sent = std::vector<std::string>;

TEST(Hub, IntroducesItselfAndSendsWhatIsSubscribed) {
  Bench bench;
  Viewer& viewer = bench.hub.add(Permission::steer);
  EXPECT_EQ(bench.sent(viewer), (Sent{"serverInfo", "advertiseServices", "advertise"}));
  bench.say(viewer, R"({"op":"subscribe","subscriptions":[{"id":9,"channelId":2}]})");
  const auto changes = bench.requests.take();
  EXPECT_EQ(changes.wanted, std::vector<std::uint32_t>{2});
  EXPECT_EQ(changes.fresh, std::vector<std::uint32_t>{2});
  bench.hub.show(5, std::vector{message_of(1, "world"), message_of(2, "poses")});
  EXPECT_EQ(bench.sent(viewer), Sent{"poses"});
  Viewer& second = bench.hub.add(Permission::look);
  EXPECT_EQ(bench.sent(second), (Sent{"serverInfo", "advertise"}));
  bench.say(second, R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":2}]})");
  EXPECT_EQ(bench.sent(second), Sent{"poses"}) << "the newest at once";
  bench.say(viewer, R"({"op":"unsubscribe","subscriptionIds":[9]})");
  bench.hub.remove(second.id);
  EXPECT_TRUE(bench.requests.take().wanted.empty());
}

TEST(Hub, AViewerThatSaysWhenItIsReadyGetsTheNewestTicksThenOnly) {
  Bench bench;
  Viewer& viewer = bench.hub.add(Permission::steer);
  bench.say(viewer, R"({"op":"subscribe","subscriptions":[{"id":9,"channelId":2}]})");
  bench.sent(viewer);
  for (const char* text : {"a", "b"}) {
    bench.hub.show(5, std::vector{message_of(2, text)});
    EXPECT_EQ(bench.sent(viewer), Sent{text}) << "one that never says it is sent all";
  }
  bench.say(viewer, R"({"op":"ready"})");
  bench.hub.show(6, std::vector{message_of(2, "c")});
  EXPECT_EQ(bench.sent(viewer), Sent{"c"});
  for (int tick = 0; tick < 100; ++tick) {
    bench.hub.show(7 + tick, std::vector{message_of(2, std::to_string(tick))});
    EXPECT_EQ(bench.sent(viewer), Sent{}) << "it has not said it again";
  }
  bench.say(viewer, R"({"op":"getParameters","parameterNames":[],"id":"1"})");
  EXPECT_EQ(bench.sent(viewer), Sent{"parameterValues"}) << "answers do not wait";
  bench.say(viewer, R"({"op":"ready"})");
  EXPECT_EQ(bench.sent(viewer), (Sent{"96", "97", "98", "99"}));
  bench.hub.show(200, std::vector{message_of(2, "later")});
  EXPECT_EQ(bench.sent(viewer), Sent{});
}

TEST(Hub, WhoComesToAWorldThatStandsGetsTheTickWhateverElseItSubscribes) {
  Bench bench;
  std::vector<channels::Channel> list;
  std::vector<channels::Message> tick;
  for (std::uint32_t id = 1; id <= 9; ++id) {
    const Kind kind = id == 9 ? Kind::barrier : id == 8 ? Kind::log : Kind::observation;
    list.push_back({id, "/topic" + std::to_string(id), kind, &schema, 0});
    if (id < 8) tick.push_back(message_of(id, std::to_string(id)));
  }
  bench.hub.set_channels(list);
  const auto subscribe = [&](Viewer& viewer) {
    bench.sent(viewer);
    for (std::uint32_t id = 1; id <= 9; ++id) {  // each by a message of its own, as browsers do
      bench.say(viewer, R"({"op":"subscribe","subscriptions":[{"id":)" + std::to_string(id) +
                            R"(,"channelId":)" + std::to_string(id) + "}]}");
    }
  };
  subscribe(bench.hub.add(Permission::look));
  bench.hub.show(5, tick);
  Viewer& second = bench.hub.add(Permission::look);
  bench.say(second, R"({"op":"ready"})");
  bench.sent(second);
  second.is_ready = false;
  subscribe(second);
  for (int i = 0; i < 20; ++i) {
    bench.hub.tell(message_of(9, "barrier" + std::to_string(i)));
    bench.hub.tell(message_of(8, "line" + std::to_string(i)));
  }
  bench.say(second, R"({"op":"ready"})");
  Sent sent = bench.sent(second);
  for (const auto& each : tick)
    EXPECT_TRUE(std::ranges::count(sent, each.content->bytes())) << each.channel;
  EXPECT_TRUE(std::ranges::count(sent, "barrier19"));
  EXPECT_FALSE(std::ranges::count(sent, "barrier18")) << "the newest is enough";
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(std::ranges::count(sent, "line" + std::to_string(i)));
}

TEST(Hub, NonsenseIsAnsweredAndEndsAtLast) {
  Bench bench;
  Viewer& viewer = bench.hub.add(Permission::steer);
  bench.sent(viewer);
  for (const char* text :
       {"", "x", "[]", "{}", R"({"op":7})", R"({"op":"subscribe"})",
        R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":2}]})",
        R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":77}]})",
        R"({"op":"subscribe","subscriptions":[3]})", R"({"op":"fetchAsset","uri":"file:///etc"})",
        R"({"op":"setParameters","parameters":[{"name":3}]})"}) {
    bench.say(viewer, text);
    EXPECT_EQ(bench.sent(viewer), Sent{"status"}) << text;
  }
  bench.say(viewer, std::string(R"({"op":"unsubscribe","subscriptionIds":[]})") + '\0' + "{}");
  EXPECT_EQ(bench.sent(viewer), Sent{"status"}) << "no JSON";
  std::mt19937 random(1);
  for (int i = 0; i < 1000 && !viewer.is_over; ++i) {
    std::string bytes(random() % 64, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    bench.hub.receive(viewer, bytes, Hub::Frame::binary);
    bench.sent(viewer);
  }
  EXPECT_TRUE(viewer.is_over);
  EXPECT_TRUE(bench.requests.take().calls.empty());
}

TEST(Hub, TheHundredthNonsenseInARowIsTheLast) {
  Bench bench;
  Viewer& viewer = bench.hub.add(Permission::look);
  bench.sent(viewer);
  for (int i = 0; i < 99; ++i) bench.say(viewer, "x");
  bench.sent(viewer);
  bench.say(viewer, R"({"op":"getParameters","parameterNames":[]})");
  for (int i = 0; i < 99; ++i) bench.say(viewer, "x");
  EXPECT_FALSE(viewer.is_over) << "99, and 99 behind a message of the protocol";
  bench.say(viewer, "x");
  EXPECT_TRUE(viewer.is_over);
}

TEST(Hub, CallsNeedTheTokenAndAreAnsweredOnce) {
  Bench bench;
  std::string call{2, 6, 0, 0, 0, 3, 0, 0, 0, 4, 0, 0, 0};
  call += R"(json{"entity":"b","position":[1,2,3]})";
  Viewer& looker = bench.hub.add(Permission::look);
  bench.sent(looker);
  bench.hub.receive(looker, call, Hub::Frame::binary);
  EXPECT_EQ(bench.sent(looker), Sent{"serviceCallFailure"});
  Viewer& viewer = bench.hub.add(Permission::steer);
  bench.hub.receive(viewer, call, Hub::Frame::binary);
  const auto calls = bench.requests.take().calls;
  ASSERT_EQ(calls.size(), 1u);
  EXPECT_EQ(calls[0].request.kind, wire::Request::Kind::move);
  EXPECT_EQ(calls[0].request.text, "b");
  EXPECT_EQ(calls[0].request.position, (std::vector<double>{1, 2, 3}));
  bench.sent(viewer);
  bench.hub.answer(calls[0], Hub::Outcome::refused, "no");
  EXPECT_EQ(bench.sent(viewer), Sent{"serviceCallFailure"});
  for (int i = 0; i < 100; ++i) bench.hub.receive(viewer, call, Hub::Frame::binary);
  EXPECT_EQ(bench.requests.take().calls.size(), Hub::most_unanswered);
}

TEST(Hub, ChannelsComeAndGo) {
  Bench bench;
  Viewer& viewer = bench.hub.add(Permission::look);
  bench.say(viewer, R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":2}]})");
  bench.sent(viewer);
  bench.hub.set_channels(
      {{1, "/world", Kind::world, &schema, 0}, {3, "/tf", Kind::transforms, &schema, 0}});
  EXPECT_EQ(bench.sent(viewer), (Sent{"unadvertise", "advertise"}));
  EXPECT_TRUE(bench.requests.take().wanted.empty());
  bench.hub.show(6, std::vector{message_of(2, "poses")});
  EXPECT_TRUE(bench.sent(viewer).empty());
}

/// Channels with these ids, which all have a schema of 100 kB.
std::vector<channels::Channel> large_channels(std::uint32_t first, std::uint32_t last) {
  static const channels::Schema large{"ziggurat.v1.Poses", std::string(100'000, 'x')};
  std::vector<channels::Channel> list;
  for (std::uint32_t id = first; id <= last; ++id)
    list.push_back({id, "/" + std::to_string(id), Kind::poses, &large, 0});
  return list;
}

/// Ids of the channels in the texts that wait, each text by itself.
std::vector<std::vector<std::uint32_t>> told(Bench& bench, Viewer& viewer, const std::string& op) {
  std::vector<std::vector<std::uint32_t>> all;
  while (auto item = bench.hub.next(viewer)) {
    if (!item->is_text) continue;
    const auto json = nlohmann::json::parse(item->head);
    if (json.at("op") != op) continue;
    EXPECT_LE(item->size(), KnownChannels::longest_list + 10'000);
    all.emplace_back();
    for (const auto& each : json.at("channels")) all.back().push_back(each.at("id"));
  }
  return all;
}

TEST(Hub, ALongListOfChannelsIsMadeInPartsAsTheViewerReads) {
  Bench bench;
  bench.hub.set_channels(large_channels(1, 10));
  Viewer& viewer = bench.hub.add(Permission::look);
  Viewer& idle = bench.hub.add(Permission::look);
  EXPECT_EQ(bench.hub.next(viewer)->is_text, true) << "serverInfo";
  EXPECT_EQ(nlohmann::json::parse(bench.hub.next(viewer)->head).at("channels").size(), 3u);
  auto list = large_channels(1, 12);
  list.erase(list.begin() + 4);  // 5, which the viewer does not know yet
  list.erase(list.begin() + 1);  // 2, which it knows
  bench.hub.set_channels(list);
  EXPECT_EQ(nlohmann::json::parse(bench.hub.next(viewer)->head).at("channelIds"),
            nlohmann::json({2}));
  EXPECT_EQ(told(bench, viewer, "advertise"),
            (std::vector<std::vector<std::uint32_t>>{{4, 6, 7}, {8, 9, 10}, {11, 12}}));
  for (int i = 0; i < 100; ++i) {
    bench.hub.set_channels(large_channels(1, 1));
    bench.hub.set_channels(large_channels(1, 4));
  }
  EXPECT_LT(idle.send_queue.size(), 1000u)
      << "nothing but serverInfo waits for one that does not read";
  EXPECT_EQ(told(bench, idle, "advertise"),
            (std::vector<std::vector<std::uint32_t>>{{1, 2, 3}, {4}}));
  const auto gone = nlohmann::json::parse(bench.hub.next(viewer)->head).at("channelIds");
  EXPECT_LE(gone.size(), 12u) << "each channel is told to be gone once";
}

TEST(Hub, TicksComeBetweenThePartsOfALongListOfChannels) {
  Bench bench;
  bench.hub.set_channels(large_channels(1, 100));
  Viewer& viewer = bench.hub.add(Permission::look);
  for (int i = 0; i < 2; ++i) EXPECT_TRUE(bench.hub.next(viewer));  // serverInfo, the first part
  bench.say(viewer, R"({"op":"subscribe","subscriptions":[{"id":9,"channelId":1}]})");
  bench.hub.show(5, std::vector{message_of(1, "a tick")});
  const Sent sent = bench.sent(viewer);
  const auto place = std::ranges::find(sent, "a tick") - sent.begin();
  EXPECT_LT(place, 4);
  EXPECT_EQ(sent.back(), "advertise");
}

TEST(Hub, AChannelThatGoesAndComesAgainIsToldAnew) {
  Bench bench;
  Viewer& viewer = bench.hub.add(Permission::look);
  bench.say(viewer, R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":2}]})");
  bench.sent(viewer);
  bench.hub.show(6, std::vector{message_of(2, "poses")});
  bench.hub.set_channels({{1, "/world", Kind::world, &schema, 0}});
  bench.hub.set_channels(
      {{1, "/world", Kind::world, &schema, 0}, {2, "/poses", Kind::poses, &schema, 0}});
  EXPECT_EQ(bench.sent(viewer), (Sent{"unadvertise", "advertise"}))
      << "and no message of the old one";
  bench.say(viewer, R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":2}]})");
  bench.hub.show(7, std::vector{message_of(2, "poses")});
  EXPECT_EQ(bench.sent(viewer), Sent{"poses"});
}

TEST(Hub, TheGraphIsSentOnceForManyQuestions) {
  Bench bench;
  Viewer& viewer = bench.hub.add(Permission::look);
  bench.sent(viewer);
  for (int i = 0; i < 100; ++i) bench.say(viewer, R"({"op":"subscribeConnectionGraph"})");
  EXPECT_EQ(bench.sent(viewer), Sent{"connectionGraphUpdate"});
  bench.hub.set_channels({{1, "/world", Kind::world, &schema, 0}});
  EXPECT_EQ(bench.sent(viewer), (Sent{"unadvertise", "connectionGraphUpdate"}));
  bench.say(viewer, R"({"op":"unsubscribeConnectionGraph"})");
  bench.hub.set_channels(
      {{1, "/world", Kind::world, &schema, 0}, {2, "/poses", Kind::poses, &schema, 0}});
  EXPECT_EQ(bench.sent(viewer), Sent{"advertise"});
}

std::string call_of(std::uint32_t service, const std::string& payload) {
  return std::string("\x02") + static_cast<char>(service) + std::string(3, '\0') +
         std::string(4, '\7') + std::string("\4\0\0\0json", 8) + payload;
}

/// Clocks as their times [ns], other messages as -1.
std::vector<std::int64_t> clocks(Bench& bench, Viewer& viewer) {
  std::vector<std::int64_t> all;
  while (auto item = bench.hub.next(viewer)) {
    std::int64_t time_ns = -1;
    if (item->head.starts_with('\x02'))
      std::memcpy(&time_ns, item->head.data() + 1, sizeof time_ns);
    all.push_back(time_ns);
  }
  return all;
}

TEST(Hub, EachViewerIsToldTheClockBeforeItsFirstMessage) {
  Bench bench;
  Viewer& first = bench.hub.add(Permission::look);
  bench.say(first, R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":1}]})");
  Viewer& second = bench.hub.add(Permission::look);
  bench.sent(first);
  bench.sent(second);
  bench.hub.show(5, std::vector{message_of(1, "world")});
  EXPECT_EQ(clocks(bench, first), (std::vector<std::int64_t>{5, -1}));
  EXPECT_TRUE(clocks(bench, second).empty()) << "it has asked for nothing";
  bench.say(
      second,
      R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":1},{"id":2,"channelId":2}]})");
  EXPECT_EQ(clocks(bench, second), (std::vector<std::int64_t>{5, -1})) << "with the newest message";
  bench.hub.show(5, std::vector{message_of(1, "world"), message_of(2, "poses")});
  EXPECT_EQ(clocks(bench, first), std::vector<std::int64_t>{-1});
  EXPECT_EQ(clocks(bench, second), (std::vector<std::int64_t>{-1, -1})) << "once for a time";
}

TEST(Hub, AViewerThatComesWithinATimeIsToldTheClockWhichStartsAfterZero) {
  for (const std::int64_t time_ns : {0, 5}) {
    Bench bench;
    bench.hub.show(time_ns, std::vector{message_of(2, "poses")});
    Viewer& viewer = bench.hub.add(Permission::look);
    bench.say(viewer, R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":2}]})");
    bench.sent(viewer);
    bench.hub.show(time_ns, std::vector{message_of(2, "poses")});
    EXPECT_EQ(clocks(bench, viewer),
              (std::vector<std::int64_t>{std::max<std::int64_t>(time_ns, 1), -1}));
  }
}

TEST(Hub, TheClockStaysWithWhatIsKeptOfADroppedTick) {
  Bench bench;
  Viewer& viewer = bench.hub.add(Permission::look);
  bench.say(
      viewer,
      R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":1},{"id":2,"channelId":2}]})");
  bench.sent(viewer);
  bench.hub.show(5, std::vector{message_of(1, "world")});
  for (int i = 0; i < 10; ++i) bench.hub.show(5, std::vector{message_of(2, "poses")});
  const auto all = clocks(bench, viewer);
  ASSERT_FALSE(all.empty());
  EXPECT_EQ(all.front(), 5);
  EXPECT_EQ(std::ranges::count(all, 5), 1);
}

TEST(Hub, ALargeCallWaitsForTheAnswersOfOthers) {
  Bench bench;
  Viewer& viewer = bench.hub.add(Permission::steer);
  bench.sent(viewer);
  const std::string large = R"({"xml":")" + std::string(Hub::largest_queued, 'x') + "\"}";
  const std::string spawn = call_of(7, large);
  for (int i = 0; i < 3; ++i) bench.hub.receive(viewer, spawn, Hub::Frame::binary);
  EXPECT_EQ(bench.requests.take().calls.size(), 1U);
  EXPECT_EQ(bench.sent(viewer), (Sent{"serviceCallFailure", "serviceCallFailure"}));
  EXPECT_FALSE(viewer.is_over);
}

TEST(Hub, JsonWithVeryManyValuesIsNotRead) {
  Bench bench;
  Viewer& viewer = bench.hub.add(Permission::steer);
  bench.sent(viewer);
  const std::string brackets(200'000, '[');
  bench.hub.receive(viewer, call_of(6, R"({"entity":"e","position":)" + brackets),
                    Hub::Frame::binary);
  std::string numbers = R"({"entity":"e","position":[0)";
  for (int i = 0; i < 200'000; ++i) numbers += ",0";
  bench.hub.receive(viewer, call_of(6, numbers + "]}"), Hub::Frame::binary);
  const std::string text = R"({"xml":"\",[[[)" + std::string(200'000, ',') + "\"}";
  bench.hub.receive(viewer, call_of(7, text), Hub::Frame::binary);
  const auto calls = bench.requests.take().calls;
  ASSERT_EQ(calls.size(), 1U) << "commas of a text are no values";
  EXPECT_EQ(calls[0].request.text.size(), 200'005U);
}

}  // namespace
}  // namespace ziggurat::view
