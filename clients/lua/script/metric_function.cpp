// SPDX-License-Identifier: MIT
#include "script/metric_function.h"

#include "script/arguments.h"
#include "script/guarded.h"

namespace ziggurat::lua {
namespace {

int metric(lua_State* state) {
  check_count(state, 2, 2, "metric(name, value)");
  const std::string_view name = check_text(state, 1);
  upvalue<Robot>(state).metric(name, check_number(state, 2));
  return 0;
}

}  // namespace

void set_metric_function(lua_State* state, Robot& robot) {
  set_function<metric>(state, "metric", &robot);
}

}  // namespace ziggurat::lua
