// SPDX-License-Identifier: MIT
// Ticks on their way to the hub: the newest wins, and nothing that must arrive is lost.

#include "view/feed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <thread>

#include "shown_world.h"

namespace ziggurat::view {
namespace {

using channels::testing::ShownWorld;

/// A world, and a viewer that has subscribed to some of its topics.
struct Watched {
  explicit Watched(std::vector<std::string> topics) {
    populate();
    feed.pass_on(hub);
    nlohmann::json entries;
    for (const std::string& topic : topics) {
      const std::uint32_t id = world.find(topic)->id;
      ids.push_back(id);
      entries.push_back({{"id", id}, {"channelId", id}});
    }
    std::ranges::sort(ids);
    hub.receive(viewer, nlohmann::json{{"op", "subscribe"}, {"subscriptions", entries}}.dump(),
                Hub::Frame::text);
    while (hub.next(viewer)) {
    }
  }

  channels::Moment moment() {
    simulation::Simulation& from = world.simulation;
    return {from.state(), from.observations(), from.commands(), from.contacts(), {}};
  }
  void populate() {
    feed.populate({world.scene, world.path, world.scene_hash, 1, 0, world.simulation.layout(),
                   world.simulation.entities(), world.simulation.state()});
  }
  void show_tick() { feed.show(moment(), {ids, {}, channels::Sensed::numbers}); }
  void show_all() { feed.show(moment(), {ids, ids, channels::Sensed::numbers}); }
  /// Messages that the viewer receives: topics with their ticks, as "/poses 3".
  std::vector<std::string> sent() {
    feed.pass_on(hub);
    std::vector<std::string> all;
    while (auto item = hub.next(viewer)) {
      if (!item->content) continue;
      for (const channels::Channel& channel : world.channels.list()) {
        if (channel.id == item->channel)
          all.push_back(channel.topic + " " + tick_in(channel, *item));
      }
    }
    return all;
  }

  static std::string tick_in(const channels::Channel& channel, const Item& item) {
    const std::string& bytes = item.content->bytes();
    if (channel.kind == channels::Kind::poses) {
      v1::Poses poses;
      EXPECT_TRUE(poses.ParseFromString(bytes));
      return std::to_string(poses.tick());
    }
    if (channel.kind == channels::Kind::command) {
      v1::Command command;
      EXPECT_TRUE(command.ParseFromString(bytes));
      return std::to_string(command.tick());
    }
    return "-";
  }

  ShownWorld world;
  ViewerRequests requests;
  Hub hub{{"1", "s", "id", false}, {}, requests};
  Viewer& viewer = hub.add(Permission::look);
  Feed feed;
  std::vector<std::uint32_t> ids;
};

using Sent = std::vector<std::string>;

TEST(Feed, TheNewestTicksWin) {
  Watched watched({"/poses"});
  for (int i = 0; i < 10; ++i) {
    watched.show_tick();
    watched.world.simulation.step();
  }
  EXPECT_EQ(watched.sent(), (Sent{"/poses 8", "/poses 9"}));
  EXPECT_TRUE(watched.sent().empty());
}

TEST(Feed, ATickIsShownAsItWas) {
  Watched watched({"/poses"});
  watched.show_tick();
  watched.world.simulation.step();  // the copy stays
  EXPECT_EQ(watched.sent(), (Sent{"/poses 0"}));
}

TEST(Feed, WhatMustArriveGoesToALaterTick) {
  Watched watched({"/world", "/poses"});
  watched.show_all();
  for (int i = 0; i < 5; ++i) {
    watched.world.simulation.step();
    watched.show_tick();
  }
  EXPECT_EQ(watched.sent(), (Sent{"/world -", "/poses 4", "/poses 5"}));
}

TEST(Feed, TicksWithoutObservationsHaveNoMessagesThatShowThem) {
  Watched watched({"/poses", "/robots/arm/observation"});
  watched.show_tick();
  EXPECT_EQ(watched.sent(), (Sent{"/poses 0", "/robots/arm/observation -"}));
  watched.feed.show(watched.moment(), {watched.ids, {}, channels::Sensed::nothing});
  EXPECT_EQ(watched.sent(), (Sent{"/poses 0"}));
}

TEST(Feed, AnswersGoWithTheirTicks) {
  Watched watched({"/poses", "/robots/arm/command"});
  for (int i = 0; i < 4; ++i) {
    watched.show_tick();
    watched.feed.show_commands(watched.moment(), watched.ids);
    watched.world.simulation.step();
  }
  EXPECT_EQ(watched.sent(),
            (Sent{"/poses 2", "/robots/arm/command 2", "/poses 3", "/robots/arm/command 3"}));
}

TEST(Feed, TicksOfAnEarlierPopulationAreNotShown) {
  Watched watched({"/world", "/poses"});
  watched.show_all();
  watched.world.simulation.step();
  watched.populate();
  watched.show_all();
  EXPECT_EQ(watched.sent(), (Sent{"/world -", "/poses 1"}));
}

TEST(Feed, EventsAreKeptAndBounded) {
  Watched watched({"/log", "/poses"});
  for (std::size_t i = 0; i < Feed::most_events + 10; ++i) {
    watched.feed.show_event(channels::Channels::log(0, channels::Severity::info, "arm", "line"));
    watched.show_tick();
  }
  const Sent sent = watched.sent();
  EXPECT_EQ(std::ranges::count(sent, "/log -"), static_cast<std::ptrdiff_t>(Feed::most_events));
}

TEST(Feed, BothThreadsAtOnce) {
  Watched watched({"/world", "/poses"});
  constexpr int ticks = 300;
  std::thread run([&] {
    for (int i = 0; i < ticks; ++i) {
      if (i % 50 == 0) {
        watched.populate();
        watched.show_all();
      } else {
        watched.show_tick();
      }
      watched.world.simulation.step();
    }
  });
  std::string last;
  while (last != "/poses 299") {
    const Sent sent = watched.sent();
    if (!sent.empty()) last = sent.back();
  }
  run.join();
}

}  // namespace
}  // namespace ziggurat::view
