// SPDX-License-Identifier: MIT
#pragma once
// The memory of one Lua state.

#include <cstddef>
#include <lua.hpp>
#include <memory>

#include "script/arena.h"
#include "script/block_pool.h"

namespace ziggurat::lua {

/// A Lua state with limited memory: a script that needs more gets Lua's error "not enough memory";
/// other scripts are not affected.
class BoundedState {
 public:
  /// @param arena  where its small blocks are as long as there is room; outlives the state
  /// @throws std::bad_alloc if an empty state does not fit
  explicit BoundedState(std::size_t max_bytes, Arena* arena = nullptr);
  BoundedState(const BoundedState&) = delete;
  BoundedState& operator=(const BoundedState&) = delete;

  lua_State* get() const { return state_.get(); }
  /// The state is in the middle of something without end (stuck_call.h): it is not used, and its
  /// memory not freed.
  void abandon() { (void)state_.release(); }
  std::size_t used_bytes() const { return budget_.used; }
  /// `FILE:LINE` where memory was last refused; empty: it was not, or outside of any Lua function.
  const char* refused_at() const { return budget_.refused_at; }

 private:
  struct Budget {
    std::size_t used;
    std::size_t max;
    BlockPool pool;
    lua_State* state = nullptr;  // once it is made
    char refused_at[LUA_IDSIZE + 16] = "";
  };
  struct Close {
    void operator()(lua_State* state) const { lua_close(state); }
  };
  static void note_place(Budget& budget);
  static void* resize(BlockPool& pool, void* block, std::size_t old_size, std::size_t new_size);
  static void* allocate(void* budget, void* block, std::size_t old_size, std::size_t new_size);
  static void* allocate_within(Budget& budget, void* block, std::size_t old_size,
                               std::size_t new_size);
  static void* change(Budget& budget, void* block, std::size_t old_size, std::size_t new_size);

  Budget budget_;
  std::unique_ptr<lua_State, Close> state_;
};

}  // namespace ziggurat::lua
