// The memory of Lua states: blocks side by side in a region, the others by malloc(), all of them
// counted.

#include "script/memory.h"

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "script/block_pool.h"
#include "script/regions.h"

namespace ziggurat::lua {
namespace {

struct alignas(16) Region {
  std::byte bytes[8 << 10];
};

TEST(BlockPool, BlocksStandSideBySideAndAreTakenAgain) {
  Region region;
  BlockPool pool(region.bytes);
  void* const first = pool.take(20);
  void* const second = pool.take(1);
  EXPECT_EQ(first, region.bytes);
  EXPECT_EQ(second, region.bytes + 32);
  pool.give_back(first, 20);
  EXPECT_EQ(pool.take(16), region.bytes + 48) << "a block of another size is no use";
  EXPECT_EQ(pool.take(32), first);
}

TEST(BlockPool, HasNoMoreThanItsMemory) {
  Region region;
  BlockPool pool(region.bytes);
  EXPECT_EQ(pool.take(4097), nullptr) << "too large for it";
  EXPECT_NE(pool.take(4096), nullptr);
  EXPECT_NE(pool.take(4095), nullptr);
  EXPECT_EQ(pool.take(1), nullptr);
  EXPECT_TRUE(pool.owns(region.bytes));
  EXPECT_TRUE(pool.owns(region.bytes + sizeof region - 1));
  EXPECT_FALSE(pool.owns(region.bytes + sizeof region));
  EXPECT_FALSE(pool.owns(&pool));
  EXPECT_FALSE(pool.owns(nullptr));
}

TEST(BlockPool, WithoutMemoryHasNoBlock) {
  BlockPool pool({});
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

TEST(BoundedState, ARegionChangesNoResult) {
  Region region;
  const BoundedState with(4 << 20, region.bytes), without(4 << 20);
  const std::string result = run(with);
  EXPECT_EQ(result, run(without));
  EXPECT_EQ(result.find_first_not_of("0123456789"), std::string::npos) << result;
}

TEST(BoundedState, BlocksInARegionAreCounted) {
  const Regions regions(1);
  const BoundedState with(4 << 20, regions[0]), without(4 << 20);
  luaL_openlibs(with.get());
  luaL_openlibs(without.get());
  EXPECT_EQ(with.used_bytes(), without.used_bytes());
  EXPECT_THROW(BoundedState(1 << 10, Regions(1)[0]), std::bad_alloc);
}

TEST(Regions, DoNotOverlap) {
  const Regions regions(3);
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_EQ(regions[i].size(), Regions::size);
    std::memset(regions[i].data(), static_cast<int>(i), Regions::size);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(regions[i].front(), static_cast<std::byte>(i));
    EXPECT_EQ(regions[i].back(), static_cast<std::byte>(i));
  }
}

}  // namespace
}  // namespace ziggurat::lua
