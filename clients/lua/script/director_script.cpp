// SPDX-License-Identifier: MIT
#include "script/director_script.h"

#include <algorithm>
#include <array>

#include "script/missing_fields.h"
#include "script/world_table.h"

namespace ziggurat::lua {

namespace {

// A function of the life cycle, and how its name is written by mistake.
struct Slip {
  const char* meant;
  std::array<const char*, 2> written;
};
constexpr std::array<Slip, 3> slips{{{"pre_step", {"prestep", "preStep"}},
                                     {"post_step", {"poststep", "postStep"}},
                                     {"is_finished", {"isfinished", "isFinished"}}}};

}  // namespace

DirectorScript::DirectorScript(Director& director, const ScriptOptions& options)
    : Script("director/" + director.id(), options), director_(director) {}

Failure DirectorScript::start() {
  const Running running(calling());
  if (auto failure = run_chunk()) return failure;
  constexpr std::array usual = {"init", "pre_step", "post_step", "is_finished"};
  if (std::ranges::none_of(usual, [this](const char* name) { return has(name); })) {
    return path() +
           ": the script has none of the functions init(), pre_step(tick), post_step(tick) and "
           "is_finished()";
  }
  doubt_names();
  if (auto failure = call("init", false, "init, tick " + std::to_string(first_tick())))
    return failure;
  return prepare_next();
}

Failure DirectorScript::step() {
  places_.clear();
  const Running running(calling());
  const std::uint64_t tick = director_.tick();
  if (auto failure = call({"post_step", false, tick}, "post_step " + std::to_string(tick)))
    return failure;
  bool is_finished = false;
  if (auto failure = call({"is_finished", false, {}}, "is_finished, tick " + std::to_string(tick),
                          &is_finished)) {
    return failure;
  }
  if (!is_finished) return prepare_next();
  director_.finish("is_finished() of " + path());
  return std::nullopt;
}

void DirectorScript::doubt_names() {
  for (const Slip& slip : slips) {
    if (has(slip.meant)) continue;
    for (const char* name : slip.written) {
      if (has(name))
        log().add(true,
                  std::string("nothing calls ") + name + "(); did you mean " + slip.meant + "()?");
    }
  }
}

Failure DirectorScript::prepare_next() {
  const std::uint64_t next = director_.tick() + 1;
  return call({"pre_step", false, next}, "pre_step " + std::to_string(next));
}

Failure DirectorScript::reset(std::uint64_t seed) {
  places_.clear();
  begin_anew(seed);
  const Running running(calling());
  if (auto failure = call("reset", false, "reset, tick 0")) return failure;
  return prepare_next();
}

Failure DirectorScript::destroy() {
  const Running running(calling());
  return call("destroy", false, "destroy, after tick " + std::to_string(director_.tick()));
}

void DirectorScript::set_up(lua_State* state) {
  push_world(state, {director_, log(), random().robot_random, first_tick(), places_});
  lua_getfield(state, -1, "metric");
  lua_setglobal(state, "metric");
  watch_missing_fields(state, "world", "director", director_.id().c_str());
  lua_setglobal(state, "world");
}

void DirectorScript::refresh(lua_State* state) { refresh_world(state, director_); }

}  // namespace ziggurat::lua
