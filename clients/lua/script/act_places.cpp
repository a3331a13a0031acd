// SPDX-License-Identifier: MIT
#include "script/act_places.h"

#include <charconv>
#include <cstring>

namespace ziggurat::lua {

void ActPlaces::add(lua_State* state) {
  Place place;
  lua_Debug caller;
  if (lua_getstack(state, 1, &caller) != 0) {
    lua_getinfo(state, "Sl", &caller);
    std::memcpy(place.file, caller.short_src, sizeof place.file);
    place.line = caller.currentline;
  }
  all_.push_back(place);
}

std::string ActPlaces::before_error_of(std::string_view field) const {
  constexpr std::string_view begin = "acts[";
  if (!field.starts_with(begin)) return {};
  std::size_t act = 0;
  std::from_chars(field.data() + begin.size(), field.data() + field.size(), act);
  if (act >= all_.size() || all_[act].line < 0) return {};
  return std::string(all_[act].file) + ":" + std::to_string(all_[act].line) + ": ";
}

}  // namespace ziggurat::lua
