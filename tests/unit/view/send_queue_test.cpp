// SPDX-License-Identifier: MIT
// Queue of a viewer is bounded; ticks are dropped whole, the newest stays.

#include "view/send_queue.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace ziggurat::view {
namespace {

Item item(std::uint32_t channel, std::size_t size, Keep keep = Keep::nothing, char mark = 'x') {
  Item made;
  made.channel = channel;
  made.keep = keep;
  made.head = std::string(size, mark);
  return made;
}

std::string marks(SendQueue& queue) {
  std::string all;
  while (auto next = queue.next()) all += next->head[0];
  return all;
}

TEST(SendQueue, DropsOldTicksWholeAndKeepsTheNewest) {
  SendQueue queue;
  for (const char tick : {'a', 'b', 'c', 'd', 'e', 'f'}) {
    queue.add_frame({item(1, 200'000, Keep::nothing, tick), item(2, 200'000, Keep::nothing, tick)});
    EXPECT_LE(queue.size(), SendQueue::most_frames);
  }
  EXPECT_EQ(marks(queue), "eeff");
  EXPECT_EQ(queue.dropped(), 4u);
  queue.add_frame({item(1, 2 * SendQueue::most_frames)});
  EXPECT_FALSE(queue.empty()) << "one that is larger than the limit is sent all the same";
}

TEST(SendQueue, FewTicksWaitHoweverSmallTheyAre) {
  SendQueue queue;
  for (char tick = 'a'; tick <= 'z'; ++tick) queue.add_frame({item(1, 10, Keep::nothing, tick)});
  EXPECT_EQ(queue.dropped(), 26 - SendQueue::most_waiting);
  EXPECT_EQ(marks(queue), "wxyz");
}

TEST(SendQueue, ATickThatWasBegunIsSentToItsEnd) {
  SendQueue queue;
  queue.add_frame({item(1, 10, Keep::nothing, 'a'), item(2, 10, Keep::nothing, 'a')});
  EXPECT_EQ(queue.next()->head[0], 'a');
  for (int i = 0; i < 5; ++i) queue.add_frame({item(1, 2'000'000, Keep::nothing, 'z')});
  EXPECT_EQ(queue.next()->head[0], 'a');
}

TEST(SendQueue, KeepsTheNewestWorldAndEachLine) {
  SendQueue queue;
  const auto fill = [&](char world, char line) {
    queue.add_frame(
        {item(7, 10, Keep::newest, world), item(8, 10, Keep::all, line), item(1, 3'000'000)});
  };
  fill('A', '1');
  fill('B', '2');
  fill('C', '3');
  const std::string all = marks(queue);
  EXPECT_EQ(all.find('A'), std::string::npos);
  EXPECT_NE(all.find('C'), std::string::npos);
  EXPECT_LT(all.find('1'), all.find('2'));
  EXPECT_LT(all.find('2'), all.find('3'));
}

TEST(SendQueue, ManyLinesDoNotTakeTheWorldWithThem) {
  SendQueue queue;
  queue.add_frame({item(7, 10, Keep::newest, 'W'), item(8, SendQueue::most_kept, Keep::all, '1'),
                   item(8, 10, Keep::all, '2')});
  for (std::size_t i = 0; i < SendQueue::most_waiting; ++i) queue.add_frame({item(1, 10)});
  const std::string all = marks(queue);
  EXPECT_EQ(all.substr(0, 2), "W2") << "the oldest line is too much";
  EXPECT_EQ(std::ranges::count(all, '1'), 0);
}

TEST(SendQueue, EventsDropNoTickAndAreBounded) {
  SendQueue queue;
  queue.add_frame({item(1, 10, Keep::nothing, 'T')});
  for (int i = 0; i < 300; ++i) {
    queue.add_to_newest({item(8, SendQueue::most_kept / 4, Keep::all, 'l')});
    queue.add_to_newest({item(9, 10, Keep::newest, 'b')});
  }
  EXPECT_EQ(queue.size(), 20 + SendQueue::most_kept);
  EXPECT_EQ(queue.dropped(), 0u);
  const std::string all = marks(queue);
  EXPECT_EQ(all[0], 'T');
  EXPECT_EQ(std::ranges::count(all, 'l'), 4);
  EXPECT_EQ(std::ranges::count(all, 'b'), 1);
  EXPECT_EQ(queue.size(), 0u);
}

TEST(SendQueue, WhatIsForgottenWaitsNoLonger) {
  SendQueue queue;
  queue.add_frame({item(1, 10, Keep::nothing, 'a'), item(2, 10, Keep::nothing, 'b')});
  queue.add_frame({item(2, 10, Keep::nothing, 'c')});
  queue.add_frame({item(3, 10, Keep::nothing, 'd')});
  const std::uint32_t gone = 2;
  queue.forget(std::span(&gone, 1));
  EXPECT_EQ(queue.size(), 20u);
  EXPECT_EQ(marks(queue), "ad");
  EXPECT_EQ(queue.size(), 0u);
}

TEST(SendQueue, TooManyAnswersAreAnError) {
  SendQueue queue;
  EXPECT_TRUE(queue.add_answer(item(0, SendQueue::most_answers)));
  EXPECT_FALSE(queue.add_answer(item(0, 1)));
}

}  // namespace
}  // namespace ziggurat::view
