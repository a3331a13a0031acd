// SPDX-License-Identifier: MIT
#include "script/world_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "script/arguments.h"
#include "script/bytes.h"
#include "script/colors.h"
#include "script/entity_table.h"
#include "script/guarded.h"
#include "script/log_functions.h"
#include "script/robot_random.h"
#include "script/tables.h"

namespace ziggurat::lua {
namespace {

const char world_key = 0;   // its address, in the registry: the table
const char places_key = 0;  // likewise: of acts

Director& director_of(lua_State* state) { return upvalue<Director>(state); }

/// An act was added to what the director asks for.
void note_act(lua_State* state) {
  lua_rawgetp(state, LUA_REGISTRYINDEX, &places_key);
  static_cast<ActPlaces*>(lua_touserdata(state, -1))->add(state);
  lua_pop(state, 1);
}

/// An entity's table or its id; valid while it is on the stack.
std::string_view check_entity(lua_State* state, int index) {
  if (lua_type(state, index) == LUA_TTABLE) {
    lua_pushliteral(state, "id");
    lua_rawget(state, index);
    lua_replace(state, index);
  }
  if (lua_type(state, index) != LUA_TSTRING)
    luaL_argerror(state, index, "an entity or its id expected");
  return check_text(state, index);
}

/// {x =, y =, z =}
std::array<double, 3> check_vector(lua_State* state, int index) {
  check_table(state, index);
  std::array<double, 3> vector{};
  constexpr std::array names = {"x", "y", "z"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    lua_getfield(state, index, names[i]);
    const double number = lua_type(state, -1) == LUA_TNUMBER ? lua_tonumber(state, -1) : NAN;
    if (!std::isfinite(number))
      luaL_argerror(state, index, "finite numbers {x =, y =, z =} expected");
    vector[i] = number;
    lua_pop(state, 1);
  }
  return vector;
}

/// {angle =, axis = {x =, y =, z =}} as a unit quaternion w, x, y, z.
std::array<double, 4> check_orientation(lua_State* state, int index) {
  check_table(state, index);
  lua_getfield(state, index, "angle");
  const double angle = lua_type(state, -1) == LUA_TNUMBER ? lua_tonumber(state, -1) : NAN;
  lua_getfield(state, index, "axis");
  if (!std::isfinite(angle) || lua_type(state, -1) != LUA_TTABLE) {
    luaL_argerror(state, index, "{angle =, axis = {x =, y =, z =}} expected");
  }
  const auto [x, y, z] = check_vector(state, lua_gettop(state));
  const double length = std::hypot(x, y, z);
  if (!(length > 0)) luaL_argerror(state, index, "the axis must have a length");
  lua_pop(state, 2);
  const double scale = std::sin(angle / 2) / length;
  return {std::cos(angle / 2), x * scale, y * scale, z * scale};
}

/// The same, or nothing.
std::optional<std::array<double, 4>> optional_orientation(lua_State* state, int index) {
  if (lua_isnoneornil(state, index)) return std::nullopt;
  return check_orientation(state, index);
}

/// {may_overlap = true}, or nothing.
Onto check_onto(lua_State* state, int index) {
  if (lua_isnoneornil(state, index)) return Onto::free_place;
  check_table(state, index);
  lua_getfield(state, index, "may_overlap");
  if (lua_type(state, -1) != LUA_TBOOLEAN)
    luaL_argerror(state, index, "{may_overlap = true} expected");
  return lua_toboolean(state, -1) ? Onto::others : Onto::free_place;
}

int move(lua_State* state) {
  check_count(state, 2, 4, "world.move(entity, position [, orientation [, {may_overlap = true}]])");
  const std::string_view entity = check_entity(state, 1);
  const auto position = check_vector(state, 2);
  const auto orientation = optional_orientation(state, 3);
  director_of(state).move(entity, position, orientation, check_onto(state, 4));
  note_act(state);
  return 0;
}

int set_joint(lua_State* state) {
  check_count(state, 3, 4, "world.set_joint(entity, joint, position [, velocity])");
  const std::string_view entity = check_entity(state, 1);
  const std::string_view joint = check_text(state, 2);
  const double position = check_number(state, 3);
  director_of(state).set_joint(entity, joint, position,
                               lua_isnoneornil(state, 4) ? 0 : check_number(state, 4));
  note_act(state);
  return 0;
}

/// True, or false and the id of what is there.
int is_free(lua_State* state) {
  check_count(state, 2, 3, "world.is_free(entity or xml, position [, orientation])");
  const std::string_view what = check_entity(state, 1);
  const auto position = check_vector(state, 2);
  const auto orientation = optional_orientation(state, 3);
  char id[256];  // an id has 255 bytes at most
  std::size_t size = 0;
  {
    const auto overlapped = director_of(state).overlapped(what, position, orientation);
    if (overlapped) size = overlapped->copy(id, sizeof id);
  }
  lua_pushboolean(state, size == 0);
  if (size > 0) lua_pushlstring(state, id, size);
  return size == 0 ? 1 : 2;
}

int spawn(lua_State* state) {
  check_count(state, 1, 1, "world.spawn(xml)");
  director_of(state).spawn(check_text(state, 1));
  note_act(state);
  return 0;
}

int remove(lua_State* state) {
  check_count(state, 1, 1, "world.remove(entity)");
  director_of(state).remove(check_entity(state, 1));
  note_act(state);
  return 0;
}

int push(lua_State* state) {
  check_count(state, 2, 4, "world.push(entity, force [, torque [, link]])");
  const std::string_view entity = check_entity(state, 1);
  const auto force = check_vector(state, 2);
  const auto torque = lua_isnoneornil(state, 3) ? std::array<double, 3>{} : check_vector(state, 3);
  director_of(state).push(entity, force, torque,
                          lua_isnoneornil(state, 4) ? std::string_view() : check_text(state, 4));
  note_act(state);
  return 0;
}

const Entity& present(lua_State* state, std::string_view id) {
  const Entity* const entity = director_of(state).find(id);
  if (entity == nullptr)
    luaL_error(state, "no entity '%s' is in the world", lua_tostring(state, 1));
  return *entity;
}

Color check_color(lua_State* state, int index) {
  const auto color = parse_color(check_text(state, index));
  if (!color)
    luaL_error(state, "'%s' is no color; write a name as red, or 'r,g,b,a'",
               lua_tostring(state, index));
  return *color;
}

/// Element i of the table at index 2, or the value there, which is for all.
void push_element(lua_State* state, std::size_t i) {
  if (lua_type(state, 2) == LUA_TTABLE) {
    lua_rawgeti(state, 2, static_cast<lua_Integer>(i) + 1);
  } else {
    lua_pushvalue(state, 2);
  }
}

/// Checks that the entity has devices of that kind, and a list a value for each.
void check_devices(lua_State* state, std::size_t count, const char* devices) {
  if (count == 0) luaL_error(state, "'%s' has no %s", lua_tostring(state, 1), devices);
  if (lua_type(state, 2) != LUA_TTABLE || lua_rawlen(state, 2) == count) return;
  luaL_error(state, "'%s' has %d %s, and the list has %d values", lua_tostring(state, 1),
             static_cast<int>(count), devices, static_cast<int>(lua_rawlen(state, 2)));
}

// Nothing with a destructor lives while Lua may raise an error: the values are checked first.
template <void (Director::*set)(std::string_view, std::span<const Color>),
          std::span<const Color> (Entity::*get)() const noexcept>
int set_colors(lua_State* state) {
  constexpr bool are_directional = get != &Entity::leds;
  check_count(state, 2, 2,
              are_directional ? "world.set_directional_leds(entity, color or list of colors)"
                              : "world.set_leds(entity, color or list of colors)");
  const std::string_view id = check_entity(state, 1);
  const std::size_t count = (present(state, id).*get)().size();
  check_devices(state, count, are_directional ? "directional LEDs" : "LEDs");
  auto* const colors = static_cast<Color*>(lua_newuserdata(state, count * sizeof(Color)));
  for (std::size_t i = 0; i < count; ++i) {
    push_element(state, i);
    colors[i] = check_color(state, lua_gettop(state));
    lua_pop(state, 1);
  }
  (director_of(state).*set)(id, {colors, count});
  note_act(state);
  return 0;
}

int set_tags(lua_State* state) {
  check_count(state, 2, 2, "world.set_tags(entity, payload or list of payloads)");
  const std::string_view id = check_entity(state, 1);
  const std::size_t count = present(state, id).tags().size();
  check_devices(state, count, "tags");
  for (std::size_t i = 0; i < count; ++i) {
    push_element(state, i);
    check_text(state, lua_gettop(state));
    lua_pop(state, 1);
  }
  std::vector<std::string> payloads(count);  // from here on Lua raises no error
  for (std::size_t i = 0; i < count; ++i) {
    push_element(state, i);
    payloads[i] = check_text(state, lua_gettop(state));
    lua_pop(state, 1);
  }
  director_of(state).set_tags(id, payloads);
  note_act(state);
  return 0;
}

constexpr lua_Integer longest_image = lua_Integer{2} << 20;  // of the floor [bytes]

constexpr const char* paint_usage =
    "world.floor.paint({x =, y =, radius =} or {x =, y =, width =, height =}, color)";

/// A number of the table at index 1; none where it has no such field.
std::optional<double> length_of(lua_State* state, const char* name) {
  lua_getfield(state, 1, name);
  const bool is_there = !lua_isnil(state, -1);
  const double number = lua_type(state, -1) == LUA_TNUMBER ? lua_tonumber(state, -1) : NAN;
  lua_pop(state, 1);
  if (!is_there) return std::nullopt;
  if (!std::isfinite(number)) luaL_error(state, "%s of the region must be a finite number", name);
  return number;
}

int paint_floor(lua_State* state) {
  check_count(state, 2, 2, paint_usage);
  check_table(state, 1);
  const auto x = length_of(state, "x"), y = length_of(state, "y");
  const auto radius = length_of(state, "radius");
  const auto width = length_of(state, "width"), height = length_of(state, "height");
  const bool is_disc = radius && !width && !height, is_rectangle = !radius && width && height;
  if (!x || !y || !(is_disc || is_rectangle))
    luaL_argerror(state, 1, "{x =, y =, radius =} or {x =, y =, width =, height =} expected");
  if (radius.value_or(1) <= 0 || width.value_or(1) <= 0 || height.value_or(1) <= 0)
    luaL_argerror(state, 1, "a region with a size above 0 expected");
  const Color color = check_color(state, 2);
  if (is_disc) {
    director_of(state).paint_floor({*x, *y}, *radius, color);
  } else {
    director_of(state).paint_floor({*x, *y}, {*width, *height}, color);
  }
  note_act(state);
  return 0;
}

/// world.floor.image(path). Upvalues: the director, and io.open, which knows the files that may be
/// read.
int lay_floor_image(lua_State* state) {
  check_count(state, 1, 1, "world.floor.image(path)");
  check_text(state, 1);
  lua_pushvalue(state, lua_upvalueindex(2));
  lua_pushvalue(state, 1);
  lua_pushliteral(state, "rb");
  lua_call(state, 2, 2);
  if (lua_isnil(state, -2)) return luaL_error(state, "%s", luaL_tolstring(state, -1, nullptr));
  lua_pop(state, 1);
  lua_getfield(state, -1, "read");
  lua_pushvalue(state, -2);
  lua_pushinteger(state, longest_image + 1);
  lua_call(state, 2, 1);
  lua_getfield(state, -2, "close");
  lua_pushvalue(state, -3);
  lua_call(state, 1, 0);
  if (lua_isnil(state, -1)) return luaL_error(state, "'%s' is empty", lua_tostring(state, 1));
  director_of(state).lay_floor_image_bytes(check_text(state, -1));
  note_act(state);
  return 0;
}

/// Adds the function to the table on top.
void set_lay_floor_image(lua_State* state, Director& director) {
  lua_pushlightuserdata(state, &director);
  lua_getglobal(state, "io");
  lua_getfield(state, -1, "open");
  lua_remove(state, -2);
  lua_pushcclosure(state, guarded<lay_floor_image>, 2);
  lua_setfield(state, -2, "image");
}

int metric(lua_State* state) {
  check_count(state, 2, 2, "metric(name, value)");
  const std::string_view name = check_text(state, 1);
  director_of(state).metric(name, check_number(state, 2));
  return 0;
}

int finish(lua_State* state) {
  check_count(state, 0, 1, "world.finish([result])");
  director_of(state).finish(lua_isnoneornil(state, 1) ? std::string_view() : check_text(state, 1));
  return 0;
}

void set_text(lua_State* state, const char* name, const std::string& text) {
  lua_pushlstring(state, text.data(), text.size());
  lua_setfield(state, -2, name);
}

void set_link_id(lua_State* state, const char* name, const Entity& entity, std::size_t link) {
  if (!entity.link_ids()[link].empty()) set_text(state, name, entity.link_ids()[link]);
}

int contacts(lua_State* state) {
  check_count(state, 0, 0, "world.contacts()");
  lua_newtable(state);
  set_elements(state, director_of(state).contacts(), [](lua_State* to, const Contact& contact) {
    lua_createtable(to, 0, 7);
    set_text(to, "first", contact.first->id());
    set_link_id(to, "first_link", *contact.first, contact.first_link);
    if (contact.second != nullptr) {
      set_text(to, "second", contact.second->id());
      set_link_id(to, "second_link", *contact.second, contact.second_link);
    }
    lua_pushboolean(to, contact.is_with_floor);
    lua_setfield(to, -2, "with_floor");
    for (const auto& [name, vector] : {std::pair{"point", &contact.point},
                                       {"normal", &contact.normal},
                                       {"force", &contact.force}}) {
      push_vector(to, *vector);
      lua_setfield(to, -2, name);
    }
  });
  return 1;
}

int messages(lua_State* state) {
  check_count(state, 0, 0, "world.messages()");
  lua_newtable(state);
  set_elements(state, director_of(state).radio_messages(),
               [](lua_State* to, const RadioMessage& message) {
                 lua_createtable(to, 0, 4);
                 set_text(to, "receiver", message.receiver->id());
                 set_integer(to, "radio", static_cast<lua_Integer>(message.receiving_radio) + 1);
                 if (message.sender != nullptr) set_text(to, "sender", message.sender->id());
                 push_bytes(to, message.payload);
                 lua_setfield(to, -2, "data");
               });
  return 1;
}

/// The table on top has each entity that is there under its id, and no other. Tables of those that
/// stay, stay.
void refresh_entities(lua_State* state, Director& director) {
  lua_pushnil(state);
  while (lua_next(state, -2) != 0) {
    lua_pop(state, 1);
    const bool is_there =
        lua_type(state, -1) == LUA_TSTRING && director.find(check_text(state, -1)) != nullptr;
    if (is_there) continue;
    lua_pushvalue(state, -1);
    lua_pushnil(state);
    lua_rawset(state, -4);
  }
  for (const Entity* entity : director.entities()) {
    lua_pushlstring(state, entity->id().data(), entity->id().size());
    if (lua_rawget(state, -2) == LUA_TNIL) {
      push_entity(state, *entity);
      set_element(state, -3, entity->id());
    }
    lua_pop(state, 1);
  }
}

}  // namespace

void push_world(lua_State* state, const WorldParts& parts) {
  Director& director = parts.director;
  prepare_entities(state, director);
  lua_pushlightuserdata(state, &parts.places);
  lua_rawsetp(state, LUA_REGISTRYINDEX, &places_key);
  lua_newtable(state);
  lua_pushvalue(state, -1);
  lua_rawsetp(state, LUA_REGISTRYINDEX, &world_key);
  set_text(state, "id", director.id());
  push_params(state, director.params());
  lua_setfield(state, -2, "params");
  set_integer(state, "first_tick", static_cast<lua_Integer>(parts.first_tick));
  push_robot_random(state, parts.random);
  lua_setfield(state, -2, "random");
  lua_newtable(state);
  lua_setfield(state, -2, "entities");
  set_log_functions(state, parts.log);
  set_function<move>(state, "move", &director);
  set_function<set_joint>(state, "set_joint", &director);
  set_function<is_free>(state, "is_free", &director);
  set_function<spawn>(state, "spawn", &director);
  set_function<remove>(state, "remove", &director);
  set_function<push>(state, "push", &director);
  set_function<set_colors<&Director::set_leds, &Entity::leds>>(state, "set_leds", &director);
  set_function<set_colors<&Director::set_directional_leds, &Entity::directional_leds>>(
      state, "set_directional_leds", &director);
  set_function<set_tags>(state, "set_tags", &director);
  lua_newtable(state);
  set_function<paint_floor>(state, "paint", &director);
  set_lay_floor_image(state, director);
  lua_setfield(state, -2, "floor");
  set_function<metric>(state, "metric", &director);
  set_function<finish>(state, "finish", &director);
  set_function<contacts>(state, "contacts", &director);
  set_function<messages>(state, "messages", &director);
}

void refresh_world(lua_State* state, Director& director) {
  lua_rawgetp(state, LUA_REGISTRYINDEX, &world_key);
  set_integer(state, "tick", static_cast<lua_Integer>(director.tick()));
  set_number(state, "time", std::chrono::duration<double>(director.time()).count());
  lua_pushliteral(state, "entities");
  const bool is_table = lua_rawget(state, -2) == LUA_TTABLE;  // the script may have changed it
  if (!is_table) {
    lua_pop(state, 1);
    lua_newtable(state);
    lua_pushvalue(state, -1);
    lua_setfield(state, -3, "entities");
  }
  if (!is_table || director.entities_have_changed()) refresh_entities(state, director);
  lua_pop(state, 2);
}

}  // namespace ziggurat::lua
