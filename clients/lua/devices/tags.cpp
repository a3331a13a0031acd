#include "devices/tags.h"

#include "script/arguments.h"
#include "script/guarded.h"

namespace ziggurat::lua {
namespace {

using Tags = std::vector<Setting<std::string>>;

void set(Setting<std::string>& tag, std::string_view payload) {
  tag.value.assign(payload);
  tag.is_fresh = true;
}

std::string_view check_payload(lua_State* state, int index) {
  const std::string_view payload = check_text(state, index);
  if (payload.size() > max_tag_payload) {
    luaL_argerror(state, index,
                  lua_pushfstring(state, "the payload has %I bytes; %I are the most",
                                  static_cast<LUAI_UACINT>(payload.size()),
                                  static_cast<LUAI_UACINT>(max_tag_payload)));
  }
  return payload;
}

int set_single_payload(lua_State* state) {
  check_count(state, 2, 2, "set_single_payload(index, payload)");
  auto& tags = upvalue<Tags>(state);
  const std::size_t position = check_position(state, 1, tags.size(), "tags");
  set(tags[position], check_payload(state, 2));
  return 0;
}

int set_all_payloads(lua_State* state) {
  check_count(state, 1, 1, "set_all_payloads(payload)");
  const std::string_view payload = check_payload(state, 1);
  for (auto& tag : upvalue<Tags>(state)) set(tag, payload);
  return 0;
}

}  // namespace

bool has_tags(const ScriptedRobot& robot) { return !robot.tags.empty(); }

void push_tags(lua_State* state, ScriptedRobot& robot) {
  lua_createtable(state, 0, 2);
  set_function<set_single_payload>(state, "set_single_payload", &robot.tags);
  set_function<set_all_payloads>(state, "set_all_payloads", &robot.tags);
}

}  // namespace ziggurat::lua
