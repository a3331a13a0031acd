// SPDX-License-Identifier: MIT
#include "script/interrupt.h"

#include <signal.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <string>

#include "script/place_file.h"
#include "script/stuck_call.h"

namespace ziggurat::lua {
namespace {

constexpr int step = 1000;            // instructions between two looks of the hook
constexpr long interval_us = 50'000;  // computing time between two looks of the signal
constexpr int looks_per_s = 1'000'000 / interval_us;
constexpr unsigned quiet_for_place =
    10;                           // such intervals without an instruction: a library function runs
constexpr int switch_cost = 100;  // of a coroutine that is resumed [instructions]
constexpr int exit_failed_script = 3;

std::atomic<bool> interrupted{false};
std::atomic<lua_State*> running{nullptr};  // the coroutine that runs now
static_assert(std::atomic<bool>::is_always_lock_free &&
              std::atomic<lua_State*>::is_always_lock_free);

// State of the running call. Written by the thread that runs scripts, and by its signal handler.
struct Watch {
  const char* robot = "";
  const char* script = "";  // its file
  std::uint64_t max_instructions = 0;
  std::uint64_t instructions = 0;  // counted so far
  bool was_seen = false;           // by the signal
  bool is_counting = false;
  bool is_over = false;           // more than max_instructions, or late
  std::uint64_t max_looks = 0;    // of the signal; 0 = any number
  std::uint64_t looks = 0;        // so far
  std::uint64_t max_quiet = 0;    // looks of the signal without an instruction between them
  std::uint64_t max_seconds = 0;  // of wall time; 0 = any number
  std::chrono::steady_clock::time_point begin{};  // if there are max_seconds
  bool is_late = false;                           // more than max_looks or max_seconds
  bool place_is_old = false;         // the place file has that of an earlier look of the signal
  std::uint64_t quiet = 0;           // looks of the signal since an instruction was counted
  char place[LUA_IDSIZE + 16] = "";  // file and line, noted last
};
Watch watch;

// The line that runs, or that has called the library function which runs. Allocates nothing.
void note_place(lua_State* state) {
  lua_Debug where{};
  for (int level = 0; lua_getstack(state, level, &where) != 0; ++level) {
    lua_getinfo(state, "Sl", &where);
    if (where.currentline <= 0) continue;
    std::snprintf(watch.place, sizeof watch.place, "%s:%d", where.short_src, where.currentline);
    return;
  }
  std::snprintf(watch.place, sizeof watch.place, "%s", watch.script);  // a coroutine of C functions
}

bool is_beyond_wall_time() {
  return watch.max_seconds > 0 &&
         std::chrono::steady_clock::now() - watch.begin > std::chrono::seconds(watch.max_seconds);
}

// Whether a library function runs for too long.
bool is_stuck() {
  if (watch.quiet > 1 && is_beyond_wall_time()) return true;
  return watch.quiet > watch.max_quiet &&
         (watch.max_instructions > 0 || watch.max_looks > 0 || watch.max_seconds > 0);
}

// The place is that which was noted, whatever called what runs now.
void raise(lua_State* state, lua_Debug*) {
  if (interrupted) {
    luaL_error(state, "interrupted");
  } else if (watch.is_late) {
    const auto limit = is_beyond_wall_time() ? watch.max_seconds : watch.max_looks / looks_per_s;
    lua_pushfstring(state, "%s: computes for more than %d s in one call: an endless loop?",
                    watch.place, static_cast<int>(limit));
  } else {
    lua_pushfstring(state,
                    "%s: runs more than %d million instructions in one call: an endless loop?",
                    watch.place, static_cast<int>(watch.max_instructions / 1'000'000));
  }
  lua_error(state);
}

constexpr int each = LUA_MASKCALL | LUA_MASKRET | LUA_MASKLINE | LUA_MASKCOUNT;

// Raises again at each instruction: a script that catches the error does not continue.
void end_script(lua_State* state) { lua_sethook(state, raise, each, 1); }

// The first instruction behind the time of the call.
void end_late(lua_State* state, lua_Debug* what) {
  if (!watch.is_late) return lua_sethook(state, nullptr, 0, 0);  // left by an earlier call
  note_place(state);
  write_place(watch.robot, watch.place);
  watch.is_over = true;
  end_script(state);
  raise(state, what);
}

void add(std::uint64_t instructions, lua_State* state) {
  watch.quiet = 0;
  watch.instructions += instructions;
  if (watch.is_over) return;
  watch.is_over = watch.max_instructions > 0 && watch.instructions > watch.max_instructions;
  if (!watch.is_over && !watch.place_is_old) return;
  watch.place_is_old = false;
  note_place(state);
  write_place(watch.robot, watch.place);
}

void count(lua_State* state, lua_Debug* what) {
  if (!watch.is_counting) return lua_sethook(state, nullptr, 0, 0);  // left by an earlier call
  add(step, state);
  if (!watch.is_over) return;
  end_script(state);
  raise(state, what);
}

// A hook that counts already stays: it would begin to count again.
void set_hook(lua_State* state) {
  if (interrupted || watch.is_over) return end_script(state);
  if (watch.is_late) return lua_sethook(state, end_late, each, 1);
  const bool counts = lua_gethook(state) == count;
  if (watch.is_counting && !counts) lua_sethook(state, count, LUA_MASKCOUNT, step);
}

[[noreturn]] void end_process() {
  char text[512];
  const int size = std::snprintf(text, sizeof text,
                                 "ziggurat-lua: '%.100s': %s: calls a library function that "
                                 "does not end; this process ends with all of its scripts\n",
                                 watch.robot, watch.place);
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text, static_cast<size_t>(size));
  ::_exit(exit_failed_script);
}

void look(int) {
  lua_State* const state = running;
  if (state == nullptr || watch.is_over) return;
  watch.place_is_old = true;
  watch.is_late = (watch.max_looks > 0 && ++watch.looks > watch.max_looks) || is_beyond_wall_time();
  if (watch.is_late) set_hook(state);
  if (!watch.was_seen) {
    watch.was_seen = true;
  } else if (!watch.is_counting) {
    watch.is_counting = true;
    set_hook(state);
  } else if (++watch.quiet; is_stuck()) {
    note_place(state);
    leave_stuck_call(state);
    if (watch.quiet > watch.max_quiet + looks_per_s) end_process();
  } else if (watch.quiet == quiet_for_place) {
    note_place(state);
    write_place(watch.robot, watch.place);
  }
}

}  // namespace

void interrupt_scripts() noexcept {
  interrupted = true;
  if (lua_State* const state = running) set_hook(state);
}

bool are_scripts_interrupted() noexcept { return interrupted; }

bool must_scripts_end() noexcept { return interrupted || watch.is_over; }

std::string where_left() {
  return std::string(watch.place) + ": " + left_function() + " computes for more than " +
         std::to_string(is_beyond_wall_time() ? watch.max_seconds : watch.max_quiet / looks_per_s) +
         " s in one call";
}

void allow_scripts() noexcept { interrupted = false; }

void watch_scripts() {
  struct sigaction action = {};
  action.sa_handler = look;
  action.sa_flags = SA_RESTART;
  ::sigemptyset(&action.sa_mask);
  ::sigaction(SIGPROF, &action, nullptr);
  static pid_t watched = 0;  // a child has no timer yet
  if (watched == ::getpid()) return;
  watched = ::getpid();
  sigevent signal = {};
  signal.sigev_notify = SIGEV_SIGNAL;
  signal.sigev_signo = SIGPROF;
  const timespec interval{0, interval_us * 1000};
  const itimerspec precise{interval, interval};
  timer_t timer;
  if (::timer_create(CLOCK_PROCESS_CPUTIME_ID, &signal, &timer) == 0 &&
      ::timer_settime(timer, 0, &precise, nullptr) == 0)
    return;
  // As where too many signals may be queued: this one counts the whole clock ticks at whose ends
  // the process ran, so that on a busy machine five seconds may be four.
  const itimerval coarse{{0, interval_us}, {0, interval_us}};
  ::setitimer(ITIMER_PROF, &coarse, nullptr);
}

Running::Running(const Calling& calling) noexcept : state_(calling.state) {
  watch = {};
  watch.robot = calling.robot;
  watch.script = calling.script;
  watch.max_instructions = calling.max_instructions;
  watch.max_looks = calling.max_computing * looks_per_s;
  watch.max_quiet = calling.max_in_library * looks_per_s;
  watch.max_seconds = calling.max_seconds;
  if (watch.max_seconds > 0) watch.begin = std::chrono::steady_clock::now();
  write_place(calling.robot, calling.script);
  running = calling.state;
  if (interrupted) set_hook(calling.state);
}

Running::~Running() {
  running = nullptr;
  write_place("", "");
  if (watch.is_counting) lua_sethook(state_, nullptr, 0, 0);
  watch = {};
}

lua_State* switch_to(lua_State* coroutine) noexcept {
  lua_State* const former = running.exchange(coroutine);
  if (watch.is_counting) add(switch_cost, former);
  set_hook(coroutine);
  return former;
}

}  // namespace ziggurat::lua
