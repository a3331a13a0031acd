// SPDX-License-Identifier: MIT
#pragma once
// The script of a director: its life cycle.

#include <cstdint>
#include <string>
#include <string_view>

#include "script/act_places.h"
#include "script/script.h"
#include "ziggurat/director.h"

namespace ziggurat::lua {

class DirectorScript final : public Script {
 public:
  /// @param director  outlives this and does not move
  /// @throws std::bad_alloc if max_memory does not hold an empty state
  DirectorScript(Director& director, const ScriptOptions& options);

  // Each of the script's functions may be missing, but not all of those that are called in every
  // run.

  /// At the first tick: runs the chunk, then init() and pre_step(tick + 1).
  Failure start();
  /// After a tick: post_step(tick), is_finished(), and unless that is true pre_step(tick + 1).
  Failure step();
  /// The world was reset to tick 0: restarts the random streams and calls reset() and pre_step(1).
  Failure reset(std::uint64_t seed);
  /// After the last tick: destroy().
  Failure destroy();

  /// Place in the script of the act that an error is about: `FILE:LINE: `; empty if that is not
  /// known. Only acts since the begin of the last call of step() or reset() are known.
  /// @param field  of the error
  std::string before_error_of(std::string_view field) const {
    return places_.before_error_of(field);
  }

 private:
  void set_up(lua_State* state) override;
  void refresh(lua_State* state) override;
  Failure prepare_next();
  /// Logs an error for each function whose name is nearly that of one that is called.
  void doubt_names();

  Director& director_;
  ActPlaces places_;
};

}  // namespace ziggurat::lua
