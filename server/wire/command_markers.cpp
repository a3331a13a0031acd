// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <string>
#include <vector>

#include "wire/command.h"
#include "wire/messages.h"
#include "ziggurat/v1/envelope.h"

namespace ziggurat::wire {
namespace {

constexpr const char* markers_field = "markers";

math::Vector3 place_of(const google::protobuf::RepeatedField<double>& values) {
  return {values[0], values[1], values[2]};
}

/// A marker without its robot. None: it has no place, or none or several of the three shapes.
std::optional<world::Marker> read(const v1::Marker& from) {
  using Shape = world::Marker::Shape;
  const bool is_arrow = from.to_size() > 0, is_ring = from.radius() != 0;
  const bool is_text = !from.text().empty();
  if (from.at_size() != 3 || is_arrow + is_ring + is_text != 1) return std::nullopt;
  if (is_arrow && from.to_size() != 3) return std::nullopt;
  world::Marker marker;
  marker.shape = is_arrow ? Shape::arrow : is_ring ? Shape::ring : Shape::text;
  marker.at = place_of(from.at());
  if (is_arrow) marker.to = place_of(from.to());
  marker.radius = from.radius();
  marker.color = from.color();
  marker.text = from.text();
  return marker;
}

std::optional<Fault> check(const v1::Marker& marker, const Roster& roster,
                           const world::Layout& layout, const std::vector<bool>& named) {
  if (auto found = check_position(marker.robot(), roster, markers_field)) return found;
  const world::RobotLayout& robot = layout.robots[roster.robots[marker.robot()]];
  if (!named.empty() && !named[marker.robot()]) {
    return make_fault(
        ErrorCode::not_yours, markers_field,
        fmt::format("The marker of robot '{}', which this command does not speak for.", robot.id),
        robot.id);
  }
  if (!robot.draws_markers) {
    return make_fault(
        ErrorCode::unknown_device, markers_field,
        fmt::format("Robot '{}' can't draw: its controller has no actuator 'debug'.", robot.id),
        robot.id);
  }
  const auto read_marker = read(marker);
  if (read_marker && is_valid(*read_marker)) return std::nullopt;
  return make_fault(ErrorCode::bad_value, markers_field,
                    fmt::format("A marker of robot '{}' must have `at` of three numbers from -1e6 "
                                "to 1e6, a color up to 0xFFFFFF, and one of: `to` of three such "
                                "numbers, a radius above 0, a text of 1 to {} bytes.",
                                robot.id, world::most_marker_text_bytes),
                    robot.id);
}

}  // namespace

void write(const world::Marker& marker, std::size_t robot, v1::Marker& to) {
  using Shape = world::Marker::Shape;
  to.set_robot(static_cast<std::uint32_t>(robot));
  for (const double value : marker.at) to.add_at(value);
  if (marker.shape == Shape::arrow) {
    for (const double value : marker.to) to.add_to(value);
  }
  if (marker.shape == Shape::ring) to.set_radius(marker.radius);
  if (marker.shape == Shape::text) to.set_text(v1::valid_utf8(marker.text));
  to.set_color(marker.color);
}

std::optional<Fault> check_markers(const v1::Command& command, const Roster& roster,
                                   const world::Layout& layout) {
  if (command.markers().empty()) return std::nullopt;
  std::vector<bool> named(command.robots().empty() ? 0 : roster.robots.size(), false);
  for (const std::uint32_t position : command.robots()) named[position] = true;
  std::vector<std::size_t> counts(roster.robots.size());
  for (const v1::Marker& marker : command.markers()) {
    if (auto found = check(marker, roster, layout, named)) return found;
    if (++counts[marker.robot()] <= world::most_markers_per_robot) continue;
    const std::string& robot = layout.robots[roster.robots[marker.robot()]].id;
    return make_fault(ErrorCode::too_many, markers_field,
                      fmt::format("Robot '{}' draws more than {} markers at this tick.", robot,
                                  world::most_markers_per_robot),
                      robot);
  }
  return std::nullopt;
}

void apply_markers(const v1::Command& command, const Roster& roster,
                   std::vector<world::Marker>& markers) {
  for (const v1::Marker& from : command.markers()) {
    if (roster.gone[from.robot()]) continue;
    markers.push_back(*read(from));
    markers.back().robot = roster.robots[from.robot()];
  }
}

void forget_markers(const Roster& roster, std::vector<world::Marker>& markers) {
  if (markers.empty()) return;
  std::erase_if(markers, [&](const world::Marker& marker) {
    const auto own = std::ranges::find(roster.robots, marker.robot);
    if (own == roster.robots.end()) return false;
    return !roster.taken[static_cast<std::size_t>(std::distance(roster.robots.begin(), own))];
  });
}

}  // namespace ziggurat::wire
