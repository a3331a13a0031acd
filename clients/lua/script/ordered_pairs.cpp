// SPDX-License-Identifier: MIT
#include "script/ordered_pairs.h"

#include <string_view>

#include "script/own_code.h"

namespace ziggurat::lua {
namespace {

// As in Lua: uses __pairs, and the loop may change or clear fields, but not add any.
constexpr std::string_view source = R"lua(
local next, type, error, select = next, type, error, select
local rawget, sort, metatable_of = rawget, table.sort, debug.getmetatable

local function comes_before(a, b)
  local kind_a, kind_b = type(a), type(b)
  if kind_a ~= kind_b then return kind_a < kind_b end  -- "number" < "string"
  return a < b
end

-- The table's keys, in order.
local function keys_of(t)
  local keys, count, others, is_ordered = {}, 0, nil, true
  for key in next, t do
    local kind = type(key)
    if kind == "number" or kind == "string" then
      is_ordered = is_ordered and (count == 0 or comes_before(keys[count], key))
      count = count + 1
      keys[count] = key
    else
      others = others or {}
      others[#others + 1] = key
    end
  end
  if not is_ordered then sort(keys, comes_before) end
  for i = 1, others and #others or 0 do keys[count + i] = others[i] end
  return keys
end

function pairs(...)
  local t = ...
  local metatable = metatable_of(t)
  local custom = type(metatable) == "table" and rawget(metatable, "__pairs")
  if custom then
    local iterator, subject, first = custom(t)
    return iterator, subject, first
  end
  if type(t) ~= "table" then
    local got = select("#", ...) == 0 and "no value" or type(t)
    error("bad argument #1 to 'pairs' (table expected, got " .. got .. ")", 2)
  end
  local keys, position = keys_of(t), 0
  return function()
    while true do
      position = position + 1
      local key = keys[position]
      if key == nil then return nil end
      local value = rawget(t, key)
      if value ~= nil then return key, value end
    end
  end, t, nil
end
)lua";

}  // namespace

void set_ordered_pairs(lua_State* state) {
  static const OwnCode code(source, "=pairs");
  code.push(state);
  lua_call(state, 0, 0);
}

}  // namespace ziggurat::lua
