// SPDX-License-Identifier: MIT
#include "script/vectors.h"

#include <array>
#include <string_view>

#include "script/own_code.h"

namespace ziggurat::lua {
namespace {

constexpr std::array names{"vector2", "vector3", "quaternion"};
// Keys of the registry.
constexpr std::array metatables{"ziggurat.vector2", "ziggurat.vector3", "ziggurat.quaternion"};
constexpr const char* shared_key = "ziggurat.vectors";
constexpr std::array basics{"type", "error", "setmetatable", "select", "next"};
constexpr std::array events{"__add", "__sub", "__mul", "__unm", "__eq", "__tostring", "__index"};

// Sets the functions that make each kind in the table that is given first, and what the metatables
// hold that follow. A quaternion also has the fields of other versions: angle, axis and yaw.
constexpr std::string_view source = R"lua(
local shared, meta2, meta3, metaq = ...
local type, error, setmetatable, select = shared.type, shared.error, shared.setmetatable, shared.select
local next, format, concat = shared.next, string.format, table.concat
local sqrt, sin, cos, asin, atan = math.sqrt, math.sin, math.cos, math.asin, math.atan
local deg, max, min = math.deg, math.max, math.min

local function is(value, fields)
  if type(value) ~= "table" then return false end
  for i = 1, #fields do
    if type(value[fields[i]]) ~= "number" then return false end
  end
  return true
end

-- A kind of tables of numbers: its name, fields, metatable, and what is common to all.
local function kind(name, fields, meta)
  for event in next, meta do meta[event] = nil end
  local self = {fields = fields, meta = meta, methods = {}}
  local sample = "a " .. name .. " {" .. concat(fields, " =, ") .. " =} expected"
  meta.__name = name
  self.meta.__index = self.methods
  function self.check(value)
    if not is(value, fields) then error(sample .. ", got " .. type(value), 3) end
    return value
  end
  -- A new one from f of the numbers of a, and of those of b.
  function self.map(f, a, b)
    local result = {}
    for i = 1, #fields do
      local key = fields[i]
      result[key] = f(a[key], b and b[key])
    end
    return setmetatable(result, self.meta)
  end
  function self.new(...)
    local result = {}
    for i = 1, #fields do result[fields[i]] = (select(i, ...)) end
    return setmetatable(result, self.meta)
  end
  function self.assign(value, from)
    for i = 1, #fields do value[fields[i]] = from[fields[i]] end
    return value
  end
  function self.dot(a, b)
    local sum = 0
    for i = 1, #fields do sum = sum + a[fields[i]] * b[fields[i]] end
    return sum
  end
  function self.meta.__eq(a, b)
    if not is(a, fields) or not is(b, fields) then return false end
    for i = 1, #fields do
      if a[fields[i]] ~= b[fields[i]] then return false end
    end
    return true
  end
  function self.methods.normalize(value)
    local length = sqrt(self.dot(self.check(value), value))
    if length == 0 then error("a " .. name .. " of length 0 has no direction", 2) end
    return self.assign(value, self.map(function(a) return a / length end, value))
  end
  return self
end

local function copy(a) return a end
local function plus(a, b) return a + b end
local function minus(a, b) return a - b end
local function negative(a) return -a end

-- Vectors have these in common.
local function vector_kind(name, fields, meta)
  local self = kind(name, fields, meta)
  local check, map, dot = self.check, self.map, self.dot
  function self.meta.__add(a, b) return map(plus, check(a), check(b)) end
  function self.meta.__sub(a, b) return map(minus, check(a), check(b)) end
  function self.meta.__unm(a) return map(negative, check(a)) end
  function self.meta.__mul(a, b)
    if type(a) == "number" then a, b = b, a end
    if type(b) ~= "number" then error("a " .. name .. " is multiplied by a number; a:dot(b) is a product of two", 2) end
    return map(function(x) return x * b end, check(a))
  end
  function self.meta.__tostring(a)
    local texts = {}
    for i = 1, #fields do texts[i] = format("%g", check(a)[fields[i]]) end
    return concat(texts, ",")
  end
  function self.methods.length(a) return sqrt(dot(check(a), a)) end
  function self.methods.dot(a, b) return dot(check(a), check(b)) end
  local usage = format("%s(), %s(v) or %s(%s)", name, name, name, concat(fields, ", "))
  shared[name] = function(...)
    local count, first = select("#", ...), ...
    if count == 0 then return map(function() return 0 end, {}) end
    if count == 1 and is(first, fields) then return map(copy, first) end
    local result = self.new(...)
    if count ~= #fields or not is(result, fields) then error("write " .. usage, 3) end
    return result
  end
  return self
end

local v2 = vector_kind("vector2", {"x", "y"}, meta2)
local v3 = vector_kind("vector3", {"x", "y", "z"}, meta3)
local q = kind("quaternion", {"w", "x", "y", "z"}, metaq)

function v2.methods.rotate(v, angle)
  if type(angle) ~= "number" then error("an angle in rad expected", 2) end
  local c, s = cos(angle), sin(angle)
  v2.check(v)
  v.x, v.y = v.x * c - v.y * s, v.x * s + v.y * c
  return v
end

local function cross(a, b)
  return a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x
end

function v3.methods.cross(a, b)
  v3.check(a)
  a.x, a.y, a.z = cross(a, v3.check(b))
  return a
end

-- v + 2 u x (u x v + w v), with u the vector of the quaternion.
function v3.methods.rotate(v, turn)
  v3.check(v)
  q.check(turn)
  local x, y, z = cross(turn, v)
  local t = {x = x + turn.w * v.x, y = y + turn.w * v.y, z = z + turn.w * v.z}
  x, y, z = cross(turn, t)
  v.x, v.y, v.z = v.x + 2 * x, v.y + 2 * y, v.z + 2 * z
  return v
end

function q.methods.inverse(a)
  q.check(a)
  return q.new(a.w, -a.x, -a.y, -a.z)
end

-- The quaternion with w >= 0 counts, of the two of a rotation: an angle from 0 to pi.
function q.methods.toangleaxis(a)
  q.check(a)
  local sine = sqrt(a.x * a.x + a.y * a.y + a.z * a.z)
  if sine == 0 then return 0, v3.new(0, 0, 1) end
  local sign = a.w < 0 and -1 or 1
  return 2 * atan(sine, sign * a.w), v3.new(sign * a.x / sine, sign * a.y / sine, sign * a.z / sine)
end

-- z, y, x [rad], as orientations in scenes: the rotation matrix is Rx Ry Rz.
function q.methods.toeulerangles(a)
  local w, x, y, z = q.check(a).w, a.x, a.y, a.z
  local pitch = 2 * (x * z + w * y)
  if pitch > 1 - 1e-12 or pitch < -1 + 1e-12 then
    return atan(2 * (x * y + w * z), 1 - 2 * (x * x + z * z)), asin(max(-1, min(1, pitch))), 0
  end
  return atan(2 * (w * z - x * y), 1 - 2 * (y * y + z * z)), asin(pitch),
         atan(2 * (w * x - y * z), 1 - 2 * (x * x + y * y))
end

function q.meta.__mul(a, b)
  q.check(a)
  q.check(b)
  return q.new(a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
               a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
               a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
               a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w)
end

function q.meta.__tostring(a)
  local z, y, x = q.methods.toeulerangles(a)
  return format("%g,%g,%g", deg(z), deg(y), deg(x))
end

local derived = {
  angle = function(a) return (q.methods.toangleaxis(a)) end,
  axis = function(a) return (select(2, q.methods.toangleaxis(a))) end,
  yaw = function(a) return atan(2 * (a.w * a.z + a.x * a.y), 1 - 2 * (a.y * a.y + a.z * a.z)) end,
}
function q.meta.__index(a, key)
  if derived[key] and is(a, q.fields) then return derived[key](a) end
  return q.methods[key]
end

function shared.quaternion(...)
  local count, first, second = select("#", ...), ...
  if count == 0 then return q.new(1, 0, 0, 0) end
  if count == 1 and is(first, q.fields) then return q.map(copy, first) end
  if count == 2 and type(first) == "number" and is(second, v3.fields) then
    local length = sqrt(v3.dot(second, second))
    if length == 0 then error("the axis has length 0", 3) end
    local scale = sin(first / 2) / length
    return q.new(cos(first / 2), second.x * scale, second.y * scale, second.z * scale)
  end
  local result = q.new(...)
  if count ~= 4 or not is(result, q.fields) then
    error("write quaternion(), quaternion(q), quaternion(angle, axis) or quaternion(w, x, y, z)", 3)
  end
  return result
end
)lua";

/// Pushes a function for that field of the table at `table`.
void push_loader(lua_State* state, int table, const char* name);

/// Pushes the metatable of that name, which is made when a script has the first vector.
void push_metatable(lua_State* state, const char* name) {
  if (lua_getfield(state, LUA_REGISTRYINDEX, name) == LUA_TTABLE) return;
  lua_pop(state, 1);
  lua_createtable(state, 0, static_cast<int>(events.size()));
  lua_pushvalue(state, -1);
  lua_setfield(state, LUA_REGISTRYINDEX, name);
  for (const char* event : events) {
    push_loader(state, -1, event);
    lua_setfield(state, -2, event);
  }
}

/// Most scripts use no vectors: their functions take 20 kB of a state and are loaded when the first
/// is called.
void load(lua_State* state) {
  lua_getfield(state, LUA_REGISTRYINDEX, shared_key);
  if (lua_getfield(state, -1, names[0]) != LUA_TNIL) return lua_pop(state, 2);
  lua_pop(state, 1);
  static const OwnCode code(source, "=vectors");
  code.push(state);
  lua_insert(state, -2);
  for (const char* metatable : metatables) push_metatable(state, metatable);
  lua_call(state, 1 + static_cast<int>(metatables.size()), 0);
}

// Upvalues: a table and the name of a field, which is called once it is loaded. Methods are a
// table.
int call_loaded(lua_State* state) {
  load(state);
  lua_pushvalue(state, lua_upvalueindex(2));
  if (lua_rawget(state, lua_upvalueindex(1)) == LUA_TTABLE) {
    lua_pushvalue(state, 2);
    lua_rawget(state, -2);
    return 1;
  }
  lua_insert(state, 1);
  lua_call(state, lua_gettop(state) - 1, LUA_MULTRET);
  return lua_gettop(state);
}

void push_loader(lua_State* state, int table, const char* name) {
  lua_pushvalue(state, table);
  lua_pushstring(state, name);
  lua_pushcclosure(state, call_loaded, 2);
}

}  // namespace

void set_vectors(lua_State* state) {
  lua_createtable(state, 0, static_cast<int>(basics.size() + names.size()));
  for (const char* name : basics) {
    lua_getglobal(state, name);
    lua_setfield(state, -2, name);
  }
  for (const char* name : names) {
    push_loader(state, -1, name);
    lua_setglobal(state, name);
  }
  lua_setfield(state, LUA_REGISTRYINDEX, shared_key);
}

void set_kind(lua_State* state, VectorKind kind) {
  const bool has_vectors = lua_getfield(state, LUA_REGISTRYINDEX, shared_key) == LUA_TTABLE;
  lua_pop(state, 1);
  if (!has_vectors) return;
  push_metatable(state, metatables[static_cast<std::size_t>(kind)]);
  lua_setmetatable(state, -2);
}

}  // namespace ziggurat::lua
