#include "outputs/reading_cameras.h"

#include <algorithm>
#include <span>
#include <vector>

#include "ziggurat/v1/envelope.h"

namespace ziggurat::outputs {
namespace {

/// Readings of a camera; they ascend by camera.
template <typename Reading>
std::span<const Reading> seen_by(std::size_t camera, const std::vector<Reading>& readings) {
  const auto first = std::ranges::lower_bound(readings, camera, {}, &Reading::camera);
  const auto last = std::ranges::upper_bound(readings, camera, {}, &Reading::camera);
  return {first, last};
}

void fill(const math::Vector2& from, v1::Pixel& to) {
  to.set_u(from.x());
  to.set_v(from.y());
}

void add_leds(std::span<const world::LedReading> seen,
              google::protobuf::RepeatedPtrField<v1::SeenLed>& out) {
  for (const world::LedReading& led : seen) {
    v1::SeenLed& to = *out.Add();
    *to.mutable_color() = color_of(led.color);
    fill(led.center, *to.mutable_center());
  }
}

}  // namespace

const world::RobotLayout& robot_with(std::size_t camera, const world::Layout& layout) {
  for (const world::RobotLayout& robot : layout.robots) {
    if (camera < robot.cameras.end()) return robot;
  }
  return layout.robots.back();
}

void add_cameras(const Moment& moment, const world::RobotLayout& robot, CameraMap& out) {
  for (std::size_t i = robot.cameras.begin; i < robot.cameras.end(); ++i) {
    v1::CameraReading& camera = out[v1::valid_utf8(moment.layout.cameras[i].id)];
    add_leds(seen_by(i, moment.observations.leds), *camera.mutable_leds());
    add_leds(seen_by(i, moment.observations.directional_leds), *camera.mutable_directional_leds());
    for (const world::TagReading& tag : seen_by(i, moment.observations.tags)) {
      v1::SeenTag& to = *camera.add_tags();
      to.set_payload(v1::valid_utf8(moment.state.tag_payloads[tag.tag]));
      fill(tag.center, *to.mutable_center());
      for (const math::Vector2& corner : tag.corners) fill(corner, *to.add_corners());
    }
  }
}

}  // namespace ziggurat::outputs
