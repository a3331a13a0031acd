// SPDX-License-Identifier: MIT
#include "camera/detectors.h"

#include <algorithm>
#include <cmath>

namespace ziggurat::camera {

using math::Vector2;
using math::Vector3;

bool faces(const math::Pose& device, const Vector3& point, double observable_angle) {
  const Vector3 axis = device.orientation * Vector3::UnitZ();
  const Vector3 way = point - device.position;
  // Exact at 0, a half and pi alike, which an arc cosine is not.
  return std::atan2(axis.cross(way).norm(), axis.dot(way)) <= observable_angle + edge;
}

std::array<Vector3, 4> tag_corners(const math::Pose& tag, double side_length) {
  const double half = side_length / 2;
  const Vector3 x = tag.orientation * Vector3(half, 0, 0);
  const Vector3 y = tag.orientation * Vector3(0, half, 0);
  const Vector3& center = tag.position;
  return {center - x - y, center - x + y, center + x + y, center + x - y};
}

View::View(const world::Layout& layout_in, const world::State& state_in,
           const media::DevicesIndex& index_in, std::size_t camera_in)
    : layout(layout_in),
      state(state_in),
      index(index_in),
      camera(camera_in),
      pose(world::pose_of(state, lens().mount)),
      from_world(math::inverse(pose)),
      corners(frustum(lens(), pose)),
      bounds(camera::bounds(corners)) {}

void detect_leds(const View& view, const LineOfSight& clear, std::vector<std::size_t>& found,
                 std::vector<world::LedReading>& readings) {
  if (!view.lens().leds) return;
  view.index.find(view.index.leds, view.bounds.low, view.bounds.high, found);
  for (const std::size_t led : found) {
    const world::Color color = view.state.led_colors[led];
    if (color == 0 || view.layout.leds[led].medium != view.lens().leds->medium) continue;
    const Vector3& position = view.index.position(view.index.leds, led);
    const auto pixel = view.find(position);
    if (!pixel || !clear(view.pose.position, position)) continue;
    readings.push_back({view.camera, color, *pixel});
  }
}

void detect_directional_leds(const View& view, const LineOfSight& clear,
                             std::vector<std::size_t>& found,
                             std::vector<world::LedReading>& readings) {
  if (!view.lens().directional_leds) return;
  view.index.find(view.index.directional_leds, view.bounds.low, view.bounds.high, found);
  for (const std::size_t i : found) {
    const world::DirectionalLedLayout& led = view.layout.directional_leds[i];
    const world::Color color = view.state.directional_led_colors[i];
    if (color == 0 || led.medium != view.lens().directional_leds->medium) continue;
    const math::Pose pose = world::pose_of(view.state, led.mount);
    if (!faces(pose, view.pose.position, led.observable_angle)) continue;
    const auto pixel = view.find(pose.position);
    if (!pixel || !clear(view.pose.position, pose.position)) continue;
    readings.push_back({view.camera, color, *pixel});
  }
}

void detect_tags(const View& view, const LineOfSight& clear, std::vector<std::size_t>& found,
                 std::vector<world::TagReading>& readings) {
  if (!view.lens().tags) return;
  // Tags with all corners in view have their centre in the frustum's box.
  view.index.find(view.index.tags, view.bounds.low, view.bounds.high, found);
  for (const std::size_t i : found) {
    const world::TagLayout& tag = view.layout.tags[i];
    if (tag.medium != view.lens().tags->medium) continue;
    const math::Pose pose = world::pose_of(view.state, tag.mount);
    if (!faces(pose, view.pose.position, tag.observable_angle)) continue;
    const std::array<Vector3, 4> corners = tag_corners(pose, tag.side_length);
    world::TagReading reading;
    reading.camera = view.camera;
    reading.tag = i;
    const auto seen = [&](std::size_t corner) {
      const auto pixel = view.find(corners[corner]);
      if (pixel) reading.corners[corner] = *pixel;
      return pixel.has_value();
    };
    if (!seen(0) || !seen(1) || !seen(2) || !seen(3)) continue;
    if (!std::ranges::all_of(
            corners, [&](const Vector3& corner) { return clear(view.pose.position, corner); })) {
      continue;
    }
    reading.center = project(view.lens(), view.from_world * pose.position);
    readings.push_back(reading);
  }
}

}  // namespace ziggurat::camera
