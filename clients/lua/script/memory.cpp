#include "script/memory.h"

#include <cstdio>
#include <cstdlib>
#include <new>

namespace ziggurat::lua {

BoundedState::BoundedState(std::size_t max_bytes)
    : budget_{0, max_bytes}, state_(lua_newstate(&allocate, &budget_)) {
  if (!state_) throw std::bad_alloc();
  budget_.state = state_.get();
}

// Needs no memory of Lua.
void BoundedState::note_place(Budget& budget) {
  lua_Debug function;
  for (int level = 0; budget.state != nullptr && lua_getstack(budget.state, level, &function) != 0; ++level) {
    lua_getinfo(budget.state, "Sl", &function);
    if (function.currentline < 0) continue;  // of C
    std::snprintf(budget.refused_at, sizeof budget.refused_at, "%s:%d", function.short_src, function.currentline);
    return;
  }
}

void* BoundedState::allocate(void* budget_of_state, void* block, std::size_t old_size,
                             std::size_t new_size) {
  auto& budget = *static_cast<Budget*>(budget_of_state);
  if (block == nullptr) old_size = 0;  // old_size is the type of the new object
  if (new_size == 0) {
    std::free(block);
    budget.used -= old_size;
    return nullptr;
  }
  // Lua requires that shrinking succeeds.
  if (new_size > old_size && new_size - old_size > budget.max - budget.used) {
    note_place(budget);
    return nullptr;
  }
  void* const moved = std::realloc(block, new_size);
  if (moved == nullptr) return new_size <= old_size ? block : nullptr;
  budget.used = budget.used - old_size + new_size;
  return moved;
}

}  // namespace ziggurat::lua
