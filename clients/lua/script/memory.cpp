// SPDX-License-Identifier: MIT
#include "script/memory.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

#include "script/interrupt.h"
#include "script/stuck_call.h"

namespace ziggurat::lua {
namespace {

// A script that must end may have it, too: each error that it raises without memory would cost a
// full collection of its garbage [bytes].
constexpr std::size_t reserve_for_errors = std::size_t{1} << 20;

}  // namespace

BoundedState::BoundedState(std::size_t max_bytes, Arena* arena)
    : budget_{0, max_bytes, BlockPool(arena)}, state_(lua_newstate(&allocate, &budget_)) {
  if (!state_) throw std::bad_alloc();
  budget_.state = state_.get();
}

// Needs no memory of Lua.
void BoundedState::note_place(Budget& budget) {
  lua_Debug function;
  for (int level = 0; budget.state != nullptr && lua_getstack(budget.state, level, &function) != 0;
       ++level) {
    lua_getinfo(budget.state, "Sl", &function);
    if (function.currentline < 0) continue;  // of C
    std::snprintf(budget.refused_at, sizeof budget.refused_at, "%s:%d", function.short_src,
                  function.currentline);
    return;
  }
}

// Blocks that have left the pool stay outside, and so do blocks that are made when it is full.
void* BoundedState::resize(BlockPool& pool, void* block, std::size_t old_size,
                           std::size_t new_size) {
  const bool pooled = pool.owns(block);
  if (block != nullptr && !pooled) return std::realloc(block, new_size);
  if (pooled && BlockPool::same_room(old_size, new_size)) return block;
  void* moved = pool.take(new_size);
  if (moved == nullptr) moved = std::malloc(new_size);
  if (pooled && moved != nullptr) {
    std::memcpy(moved, block, std::min(old_size, new_size));
    pool.give_back(block, old_size);
  }
  return moved;
}

void* BoundedState::allocate(void* budget, void* block, std::size_t old_size,
                             std::size_t new_size) {
  begin_allocation();
  void* const moved = allocate_within(*static_cast<Budget*>(budget), block, old_size, new_size);
  end_allocation();
  return moved;
}

void* BoundedState::allocate_within(Budget& budget, void* block, std::size_t old_size,
                                    std::size_t new_size) {
  if (new_size == 0) {
    if (block == nullptr) return nullptr;
    budget.pool.owns(block) ? budget.pool.give_back(block, old_size) : std::free(block);
    budget.used -= old_size;
    return nullptr;
  }
  if (block == nullptr) {
    old_size = 0;  // it was the type of the new object
    if (new_size <= budget.max - std::min(budget.max, budget.used)) {
      if (void* const taken = budget.pool.take(new_size)) {
        budget.used += new_size;
        return taken;
      }
    }
  }
  return change(budget, block, old_size, new_size);
}

/// @param new_size  > 0
void* BoundedState::change(Budget& budget, void* block, std::size_t old_size,
                           std::size_t new_size) {
  // Lua requires that shrinking succeeds.
  const std::size_t most = budget.max + (must_scripts_end() ? reserve_for_errors : 0);
  if (new_size > old_size && new_size - old_size > most - std::min(most, budget.used)) {
    note_place(budget);
    return nullptr;
  }
  void* const moved = resize(budget.pool, block, old_size, new_size);
  if (moved == nullptr) return new_size <= old_size ? block : nullptr;
  budget.used = budget.used - old_size + new_size;
  return moved;
}

}  // namespace ziggurat::lua
