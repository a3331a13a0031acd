// Output for a viewer is bounded; ticks are dropped whole, the newest stays.

#include "view/output.h"

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

std::string marks(Output& output) {
  std::string all;
  while (auto next = output.next()) all += next->head[0];
  return all;
}

TEST(Output, DropsOldTicksWholeAndKeepsTheNewest) {
  Output output;
  for (const char tick : {'a', 'b', 'c', 'd', 'e', 'f'}) {
    output.add_frame(
        {item(1, 200'000, Keep::nothing, tick), item(2, 200'000, Keep::nothing, tick)});
    EXPECT_LE(output.size(), Output::most_frames);
  }
  EXPECT_EQ(marks(output), "eeff");
  EXPECT_EQ(output.dropped(), 4u);
  output.add_frame({item(1, 2 * Output::most_frames)});
  EXPECT_FALSE(output.empty()) << "one that is larger than the limit is sent all the same";
}

TEST(Output, FewTicksWaitHoweverSmallTheyAre) {
  Output output;
  for (char tick = 'a'; tick <= 'z'; ++tick) output.add_frame({item(1, 10, Keep::nothing, tick)});
  EXPECT_EQ(output.dropped(), 26 - Output::most_waiting);
  EXPECT_EQ(marks(output), "wxyz");
}

TEST(Output, ATickThatWasBegunIsSentToItsEnd) {
  Output output;
  output.add_frame({item(1, 10, Keep::nothing, 'a'), item(2, 10, Keep::nothing, 'a')});
  EXPECT_EQ(output.next()->head[0], 'a');
  for (int i = 0; i < 5; ++i) output.add_frame({item(1, 2'000'000, Keep::nothing, 'z')});
  EXPECT_EQ(output.next()->head[0], 'a');
}

TEST(Output, KeepsTheNewestWorldAndEachLine) {
  Output output;
  const auto fill = [&](char world, char line) {
    output.add_frame({item(7, 10, Keep::newest, world), item(8, 10, Keep::all, line), item(1, 3'000'000)});
  };
  fill('A', '1');
  fill('B', '2');
  fill('C', '3');
  const std::string all = marks(output);
  EXPECT_EQ(all.find('A'), std::string::npos);
  EXPECT_NE(all.find('C'), std::string::npos);
  EXPECT_LT(all.find('1'), all.find('2'));
  EXPECT_LT(all.find('2'), all.find('3'));
}

TEST(Output, ManyLinesDoNotTakeTheWorldWithThem) {
  Output output;
  output.add_frame({item(7, 10, Keep::newest, 'W'), item(8, Output::most_kept, Keep::all, '1'),
                    item(8, 10, Keep::all, '2')});
  for (std::size_t i = 0; i < Output::most_waiting; ++i) output.add_frame({item(1, 10)});
  const std::string all = marks(output);
  EXPECT_EQ(all.substr(0, 2), "W2") << "the oldest line is too much";
  EXPECT_EQ(std::ranges::count(all, '1'), 0);
}

TEST(Output, WhatIsForgottenWaitsNoLonger) {
  Output output;
  output.add_frame({item(1, 10, Keep::nothing, 'a'), item(2, 10, Keep::nothing, 'b')});
  output.add_frame({item(2, 10, Keep::nothing, 'c')});
  output.add_frame({item(3, 10, Keep::nothing, 'd')});
  const std::uint32_t gone = 2;
  output.forget(std::span(&gone, 1));
  EXPECT_EQ(output.size(), 20u);
  EXPECT_EQ(marks(output), "ad");
  EXPECT_EQ(output.size(), 0u);
}

TEST(Output, TooManyAnswersAreAnError) {
  Output output;
  EXPECT_TRUE(output.add_answer(item(0, Output::most_answers)));
  EXPECT_FALSE(output.add_answer(item(0, 1)));
}

}  // namespace
}  // namespace ziggurat::view
