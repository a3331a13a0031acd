// SPDX-License-Identifier: MIT
#include "text/names.h"

#include <gtest/gtest.h>

#include <vector>

namespace ziggurat::text {
namespace {

TEST(EditDistance, CountsEdits) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("radius", "raduis"), 1u);  // neighbours swapped
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("orientation", "oriention"), 2u);
}

TEST(Closest, IsTheCandidateThatWasProbablyMeant) {
  const std::vector<std::string> names{"--ticks", "--trace", "--max-scene-size"};
  EXPECT_EQ(closest("--tikcs", names), "--ticks");
  EXPECT_EQ(closest("--max-scene", names), "--max-scene-size") << "a beginning is near";
  EXPECT_EQ(closest("--xyzzy", names), "");
  EXPECT_EQ(closest("--ticks", {}), "");
  EXPECT_EQ(closest(std::string(100'000'000, 'x'), names), "") << "at once";
}

TEST(Advice, NamesTheCandidateOrSaysWhatElseToDo) {
  const std::vector<std::string> names{"run", "serve"};
  EXPECT_EQ(advice("serv", names, "see the list"), "did you mean 'serve'?");
  EXPECT_EQ(advice("xyzzy", names, "see the list"), "see the list");
}

}  // namespace
}  // namespace ziggurat::text
