// SPDX-License-Identifier: MIT
#include "script/entity_table.h"

#include <array>
#include <string_view>

#include "script/arguments.h"
#include "script/guarded.h"
#include "script/tables.h"

namespace ziggurat::lua {
namespace {

const char metatable_key = 0;  // its address, in the registry

void push_link(lua_State* state, const LinkState& link) {
  lua_createtable(state, 0, 4);
  push_vector(state, link.position);
  lua_setfield(state, -2, "position");
  push_orientation(state, link.orientation);
  lua_setfield(state, -2, "orientation");
  push_vector(state, link.velocity);
  lua_setfield(state, -2, "velocity");
  push_vector(state, link.angular_velocity);
  lua_setfield(state, -2, "angular_velocity");
}

void push_joint(lua_State* state, const JointState& joint) {
  lua_createtable(state, 0, 2);
  set_number(state, "position", joint.position);
  set_number(state, "velocity", joint.velocity);
}

void push_color(lua_State* state, Color color) {
  lua_createtable(state, 0, 3);
  set_integer(state, "red", color.red);
  set_integer(state, "green", color.green);
  set_integer(state, "blue", color.blue);
}

void push_payload(lua_State* state, std::string_view payload) {
  lua_pushlstring(state, payload.data(), payload.size());
}

/// Pushes a table of states by position, from 1, and by id where there is one.
template <typename State, typename Push>
void push_states(lua_State* state, std::span<const State> all, std::span<const std::string> ids,
                 Push push) {
  lua_createtable(state, static_cast<int>(all.size()), 0);
  for (std::size_t i = 0; i < all.size(); ++i) {
    push(state, all[i]);
    if (i < ids.size() && !ids[i].empty()) {
      lua_pushvalue(state, -1);
      set_element(state, -3, ids[i]);
    }
    lua_rawseti(state, -2, static_cast<lua_Integer>(i) + 1);
  }
}

void push_first_link(lua_State* state, const Entity& entity,
                     std::array<double, 3> LinkState::*vector) {
  if (entity.links().empty()) return lua_pushnil(state);
  push_vector(state, entity.links()[0].*vector);
}

struct Property {
  std::string_view name;
  void (*push)(lua_State*, const Entity&);
};

constexpr std::array properties = {
    Property{"position", [](lua_State* state,
                            const Entity& entity) { push_vector(state, entity.pose().position); }},
    Property{"orientation",
             [](lua_State* state, const Entity& entity) {
               push_orientation(state, entity.pose().orientation);
             }},
    Property{"velocity",
             [](lua_State* state, const Entity& entity) {
               push_first_link(state, entity, &LinkState::velocity);
             }},
    Property{"angular_velocity",
             [](lua_State* state, const Entity& entity) {
               push_first_link(state, entity, &LinkState::angular_velocity);
             }},
    Property{"links",
             [](lua_State* state, const Entity& entity) {
               push_states(state, entity.links(), entity.link_ids(), push_link);
             }},
    Property{"joints",
             [](lua_State* state, const Entity& entity) {
               push_states(state, entity.joints(), entity.joint_ids(), push_joint);
             }},
    Property{"leds",
             [](lua_State* state, const Entity& entity) {
               push_states(state, entity.leds(), {}, push_color);
             }},
    Property{"directional_leds",
             [](lua_State* state, const Entity& entity) {
               push_states(state, entity.directional_leds(), {}, push_color);
             }},
    Property{"tags",
             [](lua_State* state, const Entity& entity) {
               push_states(state, entity.tags(), {}, push_payload);
             }},
    Property{"magnets",
             [](lua_State* state, const Entity& entity) {
               push_states(state, entity.magnets(), {},
                           [](lua_State* to, const std::array<double, 3>& field) {
                             push_vector(to, field);
                           });
             }},
};

const Property* property_named(std::string_view name) {
  for (const Property& each : properties) {
    if (each.name == name) return &each;
  }
  return nullptr;
}

const Property* property_at(lua_State* state, int index) {
  if (lua_type(state, index) != LUA_TSTRING) return nullptr;
  return property_named(check_text(state, index));
}

/// Entity of the table at index 1; null if it is not in the world.
const Entity* entity_of(lua_State* state) {
  lua_pushliteral(state, "id");
  lua_rawget(state, 1);
  const Entity* const entity = lua_type(state, -1) == LUA_TSTRING
                                   ? upvalue<Director>(state).find(check_text(state, -1))
                                   : nullptr;
  lua_pop(state, 1);
  return entity;
}

// entity.<key> for keys that the table does not have.
int read_property(lua_State* state) {
  check_table(state, 1);
  const Entity* const entity = entity_of(state);
  if (lua_type(state, 2) == LUA_TSTRING && check_text(state, 2) == "removed") {
    lua_pushboolean(state, entity == nullptr);
    return 1;
  }
  const Property* const property = property_at(state, 2);
  if (property == nullptr) {
    lua_pushnil(state);
    return 1;
  }
  if (entity == nullptr) {
    lua_getfield(state, 1, "id");
    return luaL_error(state, "entity '%s' is not in the world any more: it has no %s",
                      lua_tostring(state, -1), lua_tostring(state, 2));
  }
  property->push(state, *entity);
  return 1;
}

int write_field(lua_State* state) {
  check_table(state, 1);
  if (property_at(state, 2) != nullptr) {
    return luaL_error(
        state,
        "%s of an entity can't be set; world.move, world.push, world.set_leds and world.set_tags "
        "change entities",
        lua_tostring(state, 2));
  }
  lua_settop(state, 3);
  lua_rawset(state, 1);
  return 0;
}

}  // namespace

void prepare_entities(lua_State* state, Director& director) {
  lua_createtable(state, 0, 3);
  set_function<read_property>(state, "__index", &director);
  set_function<write_field>(state, "__newindex", &director);
  lua_pushliteral(state, "entity");
  lua_setfield(state, -2, "__metatable");
  lua_rawsetp(state, LUA_REGISTRYINDEX, &metatable_key);
}

void push_entity(lua_State* state, const Entity& entity) {
  lua_createtable(state, 0, 3);
  for (const auto& [name, text] : {std::pair{"id", &entity.id()},
                                   {"kind", &entity.kind()},
                                   {"controller", &entity.controller()}}) {
    lua_pushlstring(state, text->data(), text->size());
    lua_setfield(state, -2, name);
  }
  lua_rawgetp(state, LUA_REGISTRYINDEX, &metatable_key);
  lua_setmetatable(state, -2);
}

}  // namespace ziggurat::lua
