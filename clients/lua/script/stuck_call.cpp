// SPDX-License-Identifier: MIT
#include "script/stuck_call.h"

#include <pthread.h>
#include <setjmp.h>
#include <signal.h>

#include <string_view>

namespace ziggurat::lua {
namespace {

struct Leavable {
  const char* table;
  const char* name;
  lua_CFunction function = nullptr;  // of Lua; the same in each state
};

// Library functions that may compute for long, or that these call again and again.
Leavable leavable[] = {
    {"string", "byte"},   {"string", "char"},   {"string", "find"},  {"string", "format"},
    {"string", "gmatch"}, {"string", "gsub"},   {"string", "len"},   {"string", "lower"},
    {"string", "match"},  {"string", "pack"},   {"string", "rep"},   {"string", "reverse"},
    {"string", "sub"},    {"string", "unpack"}, {"string", "upper"}, {"table", "concat"},
    {"table", "insert"},  {"table", "move"},    {"table", "pack"},   {"table", "remove"},
    {"table", "sort"},    {"table", "unpack"},  {"utf8", "char"},    {"utf8", "codepoint"},
    {"utf8", "len"},      {"utf8", "offset"},   {"_G", "rawequal"},  {"_G", "rawget"},
    {"_G", "rawlen"},     {"_G", "rawset"},     {"_G", "select"},    {"_G", "tostring"},
    {"_G", "type"}};

// Iterator that string.gmatch returns.
constexpr Leavable search{"string", "gmatch"};

// Read and written by the thread that runs scripts, and by its signal handler.
sigjmp_buf way_out;
pthread_t thread_of_call;
volatile sig_atomic_t has_way_out = 0;
const Leavable* volatile left = &search;

// Upvalue: its Leavable. In one frame, so that messages name it as they do in Lua.
int call_marked(lua_State* state) {
  return static_cast<const Leavable*>(lua_touserdata(state, lua_upvalueindex(1)))->function(state);
}

// Reads only: what runs is in the middle of something.
const Leavable* find_marked(lua_State* state) {
  lua_Debug function{};
  if (lua_getstack(state, 0, &function) == 0 || lua_getinfo(state, "S", &function) == 0)
    return nullptr;
  if (std::string_view(function.what) != "C") return nullptr;
  const void* const mark = lua_touserdata(state, lua_upvalueindex(1));
  for (const Leavable& each : leavable) {
    if (mark == &each) return &each;
  }
  // It has the text, the pattern and the state of the search. Nothing else does.
  const bool is_search = lua_type(state, lua_upvalueindex(1)) == LUA_TSTRING &&
                         lua_type(state, lua_upvalueindex(2)) == LUA_TSTRING &&
                         lua_type(state, lua_upvalueindex(3)) == LUA_TUSERDATA;
  return is_search ? &search : nullptr;
}

// The handler of the signal was left, so that it is still blocked.
void unblock_signal() {
  sigset_t timer;
  ::sigemptyset(&timer);
  ::sigaddset(&timer, SIGPROF);
  ::pthread_sigmask(SIG_UNBLOCK, &timer, nullptr);
}

}  // namespace

volatile sig_atomic_t is_allocating = 0;
volatile sig_atomic_t is_leaving = 0;

void jump_out() noexcept {
  has_way_out = 0;
  is_leaving = 0;
  ::siglongjmp(way_out, 1);
}

std::optional<int> call_leavably(lua_State* state, int arguments, int results, int handler) {
  // Without the mask of signals: to save it is a system call, at each step of each robot.
  if (sigsetjmp(way_out, 0) != 0) {
    unblock_signal();
    return std::nullopt;
  }
  thread_of_call = ::pthread_self();
  has_way_out = 1;
  const int status = lua_pcall(state, arguments, results, handler);
  has_way_out = 0;
  is_leaving = 0;
  return status;
}

void mark_leavable_functions(lua_State* state) {
  for (Leavable& each : leavable) {
    lua_getglobal(state, each.table);
    lua_getfield(state, -1, each.name);
    each.function = lua_tocfunction(state, -1);
    lua_pop(state, 1);
    lua_pushlightuserdata(state, &each);
    lua_pushcclosure(state, call_marked, 1);
    lua_setfield(state, -2, each.name);
    lua_pop(state, 1);
  }
}

void leave_stuck_call(lua_State* state) noexcept {
  if (has_way_out == 0 || ::pthread_equal(thread_of_call, ::pthread_self()) == 0) return;
  const Leavable* const function = find_marked(state);
  if (function == nullptr) return;
  left = function;
  if (is_allocating == 0) jump_out();
  is_leaving = 1;
}

std::string left_function() {
  const std::string_view table = left->table;
  return (table == "_G" ? "" : std::string(table) + ".") + left->name;
}

}  // namespace ziggurat::lua
