// SPDX-License-Identifier: MIT
#pragma once
// A way out of a function of Lua's library that does not end, such as string.find with a pattern
// that tries too much: Lua calls no hook in it. A signal handler jumps out of it, to where the
// script was called. What it leaves behind, the script's Lua state, is in the middle of something
// and is never used or freed again; other scripts of the process go on. It belongs to the process,
// as signals do.

#include <signal.h>

#include <lua.hpp>
#include <optional>
#include <string>

namespace ziggurat::lua {

/// As lua_pcall, on the one thread that runs scripts. Do not nest.
/// @returns its status; none: leave_stuck_call() has ended the call, and `state` must not be used
/// again
std::optional<int> call_leavably(lua_State* state, int arguments, int results, int handler);

/// Marks functions of Lua's library that may compute for long, or are called by those that do, and
/// may be left at any instruction: they have no lock, and no memory but Lua's. May raise a Lua
/// error.
void mark_leavable_functions(lua_State* state);

/// For a signal handler, while a script computes: jumps out of its call if a marked function runs
/// now (if Lua allocates memory in it, as soon as it has it). Returns otherwise, with no effect.
/// @param state  the coroutine that runs
void leave_stuck_call(lua_State* state) noexcept;

/// The function that was left last, `string.find`.
std::string left_function();

/// Lua's memory is not left while it changes: begin_allocation() and end_allocation() are around
/// each change. Read and written by the thread that runs scripts, and by its signal handler.
extern volatile sig_atomic_t is_allocating;
extern volatile sig_atomic_t is_leaving;  ///< once the memory is allocated
[[noreturn]] void jump_out() noexcept;

inline void begin_allocation() noexcept { is_allocating = 1; }
inline void end_allocation() noexcept {
  is_allocating = 0;
  if (is_leaving != 0) [[unlikely]]
    jump_out();
}

}  // namespace ziggurat::lua
