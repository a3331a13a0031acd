// SPDX-License-Identifier: MIT
#include "scene/old_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace ziggurat::scene {
namespace {

constexpr auto attribute = OldWord::Kind::attribute;
constexpr auto element = OldWord::Kind::element;
constexpr auto value = OldWord::Kind::value;

constexpr std::string_view no_index = "bodies are found by their place without an index";
constexpr std::string_view ground = "write it on <friction> in it";
constexpr std::string_view noise_of_sight = "write noise_std_dev";
constexpr std::string_view noise_of_wheels =
    "write vel_noise_range and dist_noise_range on the sensor, bias_stddev and factor_stddev on "
    "the actuator";
constexpr std::string_view noise_of_place =
    "write pos_noise_range, angle_noise_range and axis_noise_range";
constexpr std::string_view no_collisions = "messages never collide";
constexpr std::string_view no_system = "a robot's computer is not modelled";
constexpr std::string_view new_name = "that is its name here";
constexpr std::string_view radios = "scripts use robot.radios";
constexpr std::string_view one_solver = "there is one solver, which runs until it converges";

constexpr auto words = std::to_array<OldWord>({
    {attribute, "arena", "positional_index", "", "", no_index},
    {attribute, "arena", "positional_grid_size", "", "", no_index},
    {attribute, "dynamics3d", "default_friction", "", "friction", new_name},
    {attribute, "dynamics3d", "debug_file", "", "", "record the run instead"},
    {attribute, "dynamics3d", "solver", "", "", one_solver},
    {attribute, "dynamics3d", "solver_iterations", "", "", one_solver},
    {attribute, "dynamics2d", "box_linear_friction", "", "", ground},
    {attribute, "dynamics2d", "box_angular_friction", "", "", ground},
    {attribute, "dynamics2d", "cylinder_linear_friction", "", "", ground},
    {attribute, "dynamics2d", "cylinder_angular_friction", "", "", ground},
    {attribute, "camera", "principle_point", "", "principal_point", new_name},
    {attribute, "battery", "model", "", "discharge_model", new_name},
    {attribute, "battery", "pos_delta", "", "pos_factor", new_name},
    {attribute, "battery", "orient_delta", "", "orient_factor", new_name},
    {attribute, "battery", "delta", "", "factor", new_name},
    {attribute, "battery", "noise_level", "", "", "write noise_range on the sensor"},
    {attribute, "range_and_bearing", "loss_probability", "", "packet_drop_prob", new_name},
    {attribute, "range_and_bearing", "noise_level", "", "", noise_of_sight},
    {attribute, "range_and_bearing", "real_range_noise", "", "", noise_of_sight},
    {attribute, "epuck_range_and_bearing", "loss_probability", "", "packet_drop_prob", new_name},
    {attribute, "epuck_range_and_bearing", "real_range_noise", "", "", noise_of_sight},
    {attribute, "epuck_range_and_bearing", "noise_std_deviation", "", "noise_std_dev", new_name},
    {attribute, "epuck_range_and_bearing", "nosie_std_deviation", "", "noise_std_dev", new_name},
    {attribute, "epuck_range_and_bearing", "data_size", "", "", "write rab_data_size on the robot"},
    {attribute, "epuck_range_and_bearing", "calibrated", "", "", "all sensors are alike"},
    {attribute, "colored_blob_omnidirectional_camera", "noise_level", "", "", noise_of_sight},
    {attribute, "colored_blob_perspective_camera", "noise_level", "", "", noise_of_sight},
    {attribute, "differential_steering", "noise_level", "", "", noise_of_wheels},
    {attribute, "differential_steering", "noise_std_dev", "", "", noise_of_wheels},
    {attribute, "positioning", "noise_level", "", "", noise_of_place},
    {attribute, "footbot_distance_scanner", "noise_range", "", "", "write noise_level"},
    {attribute, "", "show_rays", "", "", "the device has no rays"},
    {attribute, "", "virtual_magnetism", "", "",
     "write <magnetism/> into <dynamics3d>, and <magnets>"},
    {element, "arena", "epuck", "", "e-puck", new_name},
    {element, "entity", "epuck", "", "e-puck", new_name},
    {element, "media", "simple_radio", "", "radio", new_name},
    {element, "devices", "simple_radios", "", "radios", new_name},
    {element, "radios", "simple_radio", "", "radio", new_name},
    {element, "actuators", "simple_radios", "", "radios", radios},
    {element, "sensors", "simple_radios", "", "radios", radios},
    {attribute, "kilobot_communication", "ignore_channel_congestion", "", "", no_collisions},
    {element, "sensors", "pipuck_system", "", "", no_system},
    {element, "sensors", "builderbot_system", "", "", no_system},
    {element, "actuators", "pipuck_system", "", "", no_system},
    {element, "actuators", "builderbot_system", "", "", no_system},
    {element, "actuators", "builderbot_camera_system", "", "", "the sensor is enough"},
    {element, "sensors", "pipuck_front_camera", "", "", "write <cameras> with a <camera>"},
    {element, "dynamics3d", "srocs", "", "", "write <magnetism/>, and <magnets>"},
    {element, "", "virtual_magnetism", "", "",
     "write <magnetism/> into <dynamics3d>, and <magnets>"},
    {value, "link", "geometry", "convex_hull", "hull", new_name},
    {value, "link", "geometry", "convexhull", "hull", new_name},
    {value, "range_and_bearing", "index", "dummy", "grid",
     "devices are found by their place anyway"},
});

const OldWord* find(OldWord::Kind kind, std::string_view home, auto fits) {
  const auto found = std::ranges::find_if(words, [&](const OldWord& word) {
    return word.kind == kind && (word.home.empty() || word.home == home) && fits(word);
  });
  return found == words.end() ? nullptr : &*found;
}

}  // namespace

const OldWord* old_attribute(std::string_view home, std::string_view name) {
  return find(attribute, home, [&](const OldWord& word) { return word.word == name; });
}

const OldWord* old_name_of(std::string_view home, std::string_view name) {
  return find(attribute, home, [&](const OldWord& word) { return word.now == name; });
}

const OldWord* old_element(std::string_view home, std::string_view name) {
  return find(element, home, [&](const OldWord& word) { return word.word == name; });
}

const OldWord* old_value(std::string_view home, std::string_view name, std::string_view text) {
  return find(value, home,
              [&](const OldWord& word) { return word.word == name && word.value == text; });
}

std::string notice_of(const OldWord& word, std::string_view home) {
  const bool is_element = word.kind == OldWord::Kind::element,
             is_value = word.kind == OldWord::Kind::value;
  const std::string what = is_element ? fmt::format("<{}> in <{}>", word.word, home)
                           : is_value
                               ? fmt::format("{}=\"{}\" of <{}>", word.word, word.value, home)
                               : fmt::format("{} of <{}>", word.word, home);
  if (word.now.empty()) return fmt::format("{} has no effect here: {}", what, word.why);
  const std::string now = is_element ? fmt::format("<{}>", word.now)
                          : is_value ? fmt::format("\"{}\"", word.now)
                                     : std::string(word.now);
  return fmt::format("{} is read as {}: {}", what, now, word.why);
}

}  // namespace ziggurat::scene
