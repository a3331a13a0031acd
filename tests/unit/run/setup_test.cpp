// SPDX-License-Identifier: MIT
#include "run/setup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>
#include <vector>

namespace ziggurat::run {
namespace {

std::vector<scene::Entity> entities(std::size_t moving, std::size_t fixed) {
  std::vector<scene::Entity> all(moving + fixed);
  for (std::size_t i = moving; i < all.size(); ++i) all[i].movable = false;
  return all;
}

TEST(ThreadsFor, TakesAllProcessorsWhereManyBodiesMove) {
  const unsigned processors = std::max(1U, std::thread::hardware_concurrency());
  EXPECT_EQ(threads_for({}, entities(64, 0)), processors);
  EXPECT_EQ(threads_for({}, entities(63, 1000)), 1U) << "few move";
  EXPECT_EQ(threads_for({}, {}), 1U);
}

TEST(ThreadsFor, ObeysTheOption) {
  Options options;
  options.threads = 3;
  EXPECT_EQ(threads_for(options, entities(1, 0)), 3U);
  EXPECT_EQ(threads_for(options, entities(1000, 0)), 3U);
}

}  // namespace
}  // namespace ziggurat::run
