#include "devices/shapes.h"

#include <algorithm>
#include <numbers>

#include "script/tables.h"

namespace ziggurat::lua {
namespace {

constexpr double turns_per_minute = std::numbers::pi / 30;  // [rad/s]

constexpr FieldShape offsets[] = {{"offset_x", "offset.x", centimetres},
                                  {"offset_y", "offset.y", centimetres}};
constexpr FieldShape distances[] = {{"distance", "distance", centimetres}};

constexpr FunctionShape switches[] = {
    {"enable", "enable()", false, {{{"enabled", 1}}}},
    {"disable", "disable()", false, {{{"enabled", 0}}}},
};
constexpr FunctionShape scanner_functions[] = {
    {"enable", "enable()", false, {{{"mode", 1}}}},
    {"disable", "disable()", false, {{{"mode", 0}}}},
    {"set_angle", "set_angle(angle)", true, {{{"mode", 1}, {"angle", 0, 1}}}},
    {"set_rpm", "set_rpm(turns_per_minute)", true, {{{"mode", 2}, {"speed", 0, turns_per_minute}}}},
};

constexpr FunctionShape gripper_functions[] = {
    {"lock", "lock()", false, {{{"lock", 1}}}},
    {"unlock", "unlock()", false, {{{"lock", 0}}}},
};
constexpr FunctionShape footbot_gripper_functions[] = {
    {"lock_positive", "lock_positive()", false, {{{"lock", 1}}}},
    {"lock_negative", "lock_negative()", false, {{{"lock", 1}}}},
    {"unlock", "unlock()", false, {{{"lock", 0}}}},
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
    {"footbot_gripper", "gripper", {}, footbot_gripper_functions},
};

}  // namespace

const Shape* find_shape(std::string_view kind) {
  const auto* const found = std::ranges::find(shapes, kind, &Shape::kind);
  return found == std::end(shapes) ? nullptr : found;
}

}  // namespace ziggurat::lua
