// SPDX-License-Identifier: MIT
// The memory of Lua states: blocks side by side in an arena, the others by malloc(), all of them
// counted.

#include "script/memory.h"

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "script/arena.h"
#include "script/block_pool.h"

namespace ziggurat::lua {
namespace {

TEST(BlockPool, BlocksStandSideBySideAndAreTakenAgain) {
  Arena arena(1);
  BlockPool pool(&arena);
  auto* const first = static_cast<std::byte*>(pool.take(20));
  EXPECT_EQ(pool.take(1), first + 32);
  pool.give_back(first, 20);
  EXPECT_EQ(pool.take(16), first + 48) << "a block of another size is no use";
  EXPECT_EQ(pool.take(32), first);
  EXPECT_EQ(pool.take(513), nullptr) << "too large for it";
  for (std::size_t i = 0; i < 7; ++i) EXPECT_EQ(pool.take(512), first + 64 + 512 * i);
  EXPECT_EQ(pool.take(500), first + 64 + 512 * 7) << "the last of the chunk";
  EXPECT_EQ(pool.take(512), first + Arena::chunk) << "in the next chunk";
}

TEST(BlockPool, WhatIsLeftOfAChunkIsABlock) {
  Arena arena(1);
  BlockPool pool(&arena);
  auto* const first = static_cast<std::byte*>(pool.take(480));
  for (int i = 0; i < 7; ++i) pool.take(512);
  EXPECT_EQ(pool.take(512), first + Arena::chunk);
  EXPECT_EQ(pool.take(96), first + 480 + 7 * 512);
}

TEST(BlockPool, HasNoMoreThanItsPartOfTheArena) {
  Arena arena(2);
  BlockPool greedy(&arena), modest(&arena);
  void* last = nullptr;
  for (std::size_t i = 0; i < Arena::most_chunks * (Arena::chunk / 512); ++i) {
    last = greedy.take(512);
    ASSERT_NE(last, nullptr);
    EXPECT_TRUE(greedy.owns(last));
  }
  EXPECT_EQ(greedy.take(512), nullptr);
  void* const other = modest.take(512);
  ASSERT_NE(other, nullptr);
  EXPECT_TRUE(arena.owns(other));
  EXPECT_FALSE(greedy.owns(&greedy));
  EXPECT_FALSE(greedy.owns(nullptr));
}

TEST(BlockPool, WithoutMemoryHasNoBlock) {
  BlockPool pool(nullptr);
  EXPECT_EQ(pool.take(1), nullptr);
  EXPECT_FALSE(pool.owns(nullptr));
  EXPECT_FALSE(pool.owns(&pool));
}

/// Memory that a program gives back, where its blocks grow, shrink and end by turns.
std::string run(const BoundedState& state) {
  luaL_openlibs(state.get());
  constexpr char program[] =
      "local kept, sum = {}, 0 "
      "for i = 1, 20000 do "
      "  kept[i % 97] = {name = ('x'):rep(i % 300), i, i + 1, i + 2} "
      "  if i % 1000 == 0 then collectgarbage() end "
      "end "
      "local big = {} for i = 1, 20000 do big[i] = i .. '' end "
      "big = nil collectgarbage() "
      "for k, v in pairs(kept) do sum = sum + #v.name + v[2] end "
      "return sum .. ''";
  if (luaL_dostring(state.get(), program) != LUA_OK) return lua_tostring(state.get(), -1);
  return lua_tostring(state.get(), -1);
}

TEST(BoundedState, AnArenaChangesNoResult) {
  Arena arena(1);
  const BoundedState with(4 << 20, &arena), without(4 << 20);
  const std::string result = run(with);
  EXPECT_EQ(result, run(without));
  EXPECT_EQ(result.find_first_not_of("0123456789"), std::string::npos) << result;
}

TEST(BoundedState, BlocksInAnArenaAreCounted) {
  Arena arena(2);
  const BoundedState with(4 << 20, &arena), without(4 << 20);
  luaL_openlibs(with.get());
  luaL_openlibs(without.get());
  EXPECT_EQ(with.used_bytes(), without.used_bytes());
  EXPECT_THROW(BoundedState(1 << 10, &arena), std::bad_alloc);
}

TEST(Arena, ChunksDoNotOverlap) {
  Arena arena(1);
  std::vector<std::span<std::byte>> chunks;
  for (auto chunk = arena.take(); !chunk.empty(); chunk = arena.take()) {
    std::memset(chunk.data(), static_cast<int>(chunks.size() % 256), chunk.size());
    chunks.push_back(chunk);
  }
  EXPECT_GE(chunks.size(), Arena::most_chunks);
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    EXPECT_EQ(chunks[i].front(), static_cast<std::byte>(i % 256));
    EXPECT_EQ(chunks[i].back(), static_cast<std::byte>(i % 256));
  }
}

}  // namespace
}  // namespace ziggurat::lua
