#include "script/interrupt.h"

#include <atomic>

namespace ziggurat::lua {
namespace {

std::atomic<bool> interrupted{false};
std::atomic<lua_State*> running{nullptr};
static_assert(std::atomic<bool>::is_always_lock_free &&
              std::atomic<lua_State*>::is_always_lock_free);

void raise(lua_State* state, lua_Debug*) { luaL_error(state, "interrupted"); }

// Raises again at each instruction: a script that catches the error does not continue.
void set_hook(lua_State* state) {
  constexpr int each = LUA_MASKCALL | LUA_MASKRET | LUA_MASKLINE | LUA_MASKCOUNT;
  lua_sethook(state, raise, each, 1);
}

}  // namespace

void interrupt_scripts() noexcept {
  interrupted = true;
  if (lua_State* const state = running) set_hook(state);
}

bool are_scripts_interrupted() noexcept { return interrupted; }

void allow_scripts() noexcept { interrupted = false; }

Running::Running(lua_State* state) noexcept {
  running = state;
  if (interrupted) set_hook(state);
}

Running::~Running() { running = nullptr; }

}  // namespace ziggurat::lua
