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

TEST(LuaProcessesFor, ManyRobotsShareAsManyAsThreads) {
  EXPECT_EQ(lua_processes_for({}, 8, 0), 1U);
  EXPECT_EQ(lua_processes_for({}, 8, 127), 1U);
  EXPECT_EQ(lua_processes_for({}, 8, 128), 2U);
  EXPECT_EQ(lua_processes_for({}, 8, 1024), 8U);
  EXPECT_EQ(lua_processes_for({}, 1, 1024), 1U) << "the runs of a sweep share the processors";
}

TEST(LuaProcessesFor, ObeysTheOption) {
  Options options;
  options.lua_processes = 0;
  EXPECT_EQ(lua_processes_for(options, 8, 1024), 0U) << "one for each robot";
  options.lua_processes = 5;
  EXPECT_EQ(lua_processes_for(options, 1, 2), 5U);
}

}  // namespace
}  // namespace ziggurat::run
