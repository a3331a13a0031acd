// SPDX-License-Identifier: MIT
#include "devices/shapes.h"

#include <algorithm>
#include <numbers>

#include "script/tables.h"

namespace ziggurat::lua {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double turns_per_minute = std::numbers::pi / 30;  // [rad/s]

constexpr FieldShape offsets[] = {{"offset_x", "offset.x", centimetres},
                                  {"offset_y", "offset.y", centimetres}};
constexpr FieldShape distances[] = {{"distance", "distance", centimetres}};

constexpr FunctionShape switches[] = {
    {"enable", "enable()", 0, {{{"enabled", 1}}}},
    {"disable", "disable()", 0, {{{"enabled", 0}}}},
};
constexpr FunctionShape scanner_functions[] = {
    {"enable", "enable()", 0, {{{"mode", 1}}}},
    {"disable", "disable()", 0, {{{"mode", 0}}}},
    {"set_angle", "set_angle(angle)", 1, {{{"mode", 1}, {"angle", 0, 1}}}},
    {"set_rpm", "set_rpm(turns_per_minute)", 1, {{{"mode", 2}, {"speed", 0, turns_per_minute}}}},
};

/// Modes of moving and of turning: 1 absolute, 2 relative, 3 speed.
constexpr FunctionShape quadrotor_functions[] = {
    {"set_absolute_position",
     "set_absolute_position(x, y, z)",
     3,
     {{{"move_mode", 1}, {"x", 0, 1, 0}, {"y", 0, 1, 1}, {"z", 0, 1, 2}}}},
    {"set_relative_position",
     "set_relative_position(x, y, z)",
     3,
     {{{"move_mode", 2},
       {"x", 0, 1, 0},
       {"y", 0, 1, 1},
       {"z", 0, 1, 2},
       {"moves", 1, 0, 0, true}}}},
    {"set_absolute_yaw", "set_absolute_yaw(degrees)", 1, {{{"turn_mode", 1}, {"yaw", 0, degree}}}},
    {"set_relative_yaw",
     "set_relative_yaw(degrees)",
     1,
     {{{"turn_mode", 2}, {"yaw", 0, degree}, {"turns", 1, 0, 0, true}}}},
    {"set_linear_velocity",
     "set_linear_velocity(x, y, z)",
     3,
     {{{"move_mode", 3},
       {"velocity_x", 0, 1, 0},
       {"velocity_y", 0, 1, 1},
       {"velocity_z", 0, 1, 2}}}},
    {"set_rotational_speed",
     "set_rotational_speed(speed)",
     1,
     {{{"turn_mode", 3}, {"yaw_rate", 0, 1}}}},
};

constexpr FieldShape message[] = {{"distance", "distance", centimetres},
                                  {"data_1", "data.1"},
                                  {"data_2", "data.2"},
                                  {"data_3", "data.3"},
                                  {"data_4", "data.4"},
                                  {"data_5", "data.5"},
                                  {"data_6", "data.6"},
                                  {"data_7", "data.7"},
                                  {"data_8", "data.8"},
                                  {"data_9", "data.9"}};
constexpr FunctionShape message_functions[] = {
    {"set_message",
     "set_message(byte, … nine of them)",
     9,
     {{{"enabled", 1},
       {"data_1", 0, 1, 0},
       {"data_2", 0, 1, 1},
       {"data_3", 0, 1, 2},
       {"data_4", 0, 1, 3},
       {"data_5", 0, 1, 4},
       {"data_6", 0, 1, 5},
       {"data_7", 0, 1, 6},
       {"data_8", 0, 1, 7},
       {"data_9", 0, 1, 8}}}},
    {"stop", "stop()", 0, {{{"enabled", 0}}}},
};
constexpr FunctionShape motor_functions[] = {
    {"set_motors", "set_motors(left, right)", 2, {{{"left", 0, 1, 0}, {"right", 0, 1, 1}}}},
};

constexpr FunctionShape gripper_functions[] = {
    {"lock", "lock()", 0, {{{"lock", 1}}}},
    {"lock_positive", "lock_positive()", 0, {{{"lock", 1}}}},
    {"lock_negative", "lock_negative()", 0, {{{"lock", 1}}}},
    {"unlock", "unlock()", 0, {{{"lock", 0}}}},
};
constexpr FunctionShape drive_functions[] = {
    {"set_linear_velocity",
     "set_linear_velocity(left, right)",
     2,
     {{{"left", 0, 1, 0}, {"right", 0, 1, 1}}}},
};
constexpr FunctionShape lift_functions[] = {
    {"set_position", "set_position(height)", 1, {{{"position", 0, 1}}}},
};

constexpr Shape shapes[] = {
    {"footbot_light", "light"},
    {"eyebot_light", "light"},
    {"epuck_light", "light"},
    {"epuck_proximity", "proximity"},
    {"epuck_ground", "ground", offsets},
    {"footbot_base_ground", "base_ground", offsets},
    {"footbot_motor_ground", "motor_ground", offsets},
    {"footbot_distance_scanner",
     "distance_scanner",
     distances,
     scanner_functions,
     "is_long",
     {"short_range", "long_range"}},
    {"colored_blob_omnidirectional_camera", "colored_blob_omnidirectional_camera", distances,
     switches},
    {"colored_blob_perspective_camera", "colored_blob_perspective_camera", {}, switches},
    {"gripper", "gripper", {}, gripper_functions},
    {"quadrotor", "quadrotor", {}, quadrotor_functions},
    {"kilobot_differential_drive", "motors", {}, motor_functions},
    {"kilobot_communication", "communication", message, message_functions},
    {"kheperaiv_ultrasound", "ultrasound", distances},
    {"differential_drive", "differential_drive", {}, drive_functions},
    {"lift_system", "lift_system", {}, lift_functions},
};

}  // namespace

const Shape* find_shape(std::string_view kind) {
  const auto* const found = std::ranges::find(shapes, kind, &Shape::kind);
  return found == std::end(shapes) ? nullptr : found;
}

}  // namespace ziggurat::lua
