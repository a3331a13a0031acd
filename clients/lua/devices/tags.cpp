// SPDX-License-Identifier: MIT
// robot.tags: set_single_payload(index, payload), set_all_payloads(payload)

#include "devices/device_table.h"
#include "script/arguments.h"
#include "script/guarded.h"

namespace ziggurat::lua {
namespace {

int set_single_payload(lua_State* state) {
  check_count(state, 2, 2, "set_single_payload(index, payload)");
  const std::span<Tag> tags = upvalue<Robot>(state).tags();
  const std::size_t position = check_position(state, 1, tags.size(), "tags");
  tags[position].set_payload(check_text(state, 2));
  return 0;
}

int set_all_payloads(lua_State* state) {
  check_count(state, 1, 1, "set_all_payloads(payload)");
  const std::string_view payload = check_text(state, 1);
  for (Tag& tag : upvalue<Robot>(state).tags()) tag.set_payload(payload);
  return 0;
}

void make_tags(lua_State* state, Robot& robot) {
  lua_createtable(state, 0, 2);
  set_function<set_single_payload>(state, "set_single_payload", &robot);
  set_function<set_all_payloads>(state, "set_all_payloads", &robot);
}

}  // namespace

extern const DeviceKind tags_kind{"tags", [](Robot& robot) { return !robot.tags().empty(); },
                                  make_tags, nullptr};

}  // namespace ziggurat::lua
