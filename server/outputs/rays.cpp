// SPDX-License-Identifier: MIT
#include "outputs/rays.h"

#include <utility>

#include "outputs/json.h"
#include "outputs/reading.h"
#include "ziggurat/v1/envelope.h"
#include "ziggurat/v1/recording.pb.h"

namespace ziggurat::outputs {
namespace {

const char* name_of(world::Ray::Kind kind) {
  switch (kind) {
    case world::Ray::Kind::proximity:
      return "proximity";
    case world::Ray::Kind::radio:
      return "radio";
    case world::Ray::Kind::range_and_bearing:
      return "range_and_bearing";
    case world::Ray::Kind::camera:
      return "camera";
    case world::Ray::Kind::device:
      return "device";
  }
  return "";
}

v1::RayLine line_of(const world::State& state, const char* kind, const std::string& robot) {
  v1::RayLine line;
  line.set_tick(state.tick);
  line.set_time_s(static_cast<double>(state.time_ns) / 1e9);
  line.set_kind(kind);
  line.set_robot(v1::valid_utf8(robot));
  return line;
}

}  // namespace

Rays::Rays(std::string path, const world::Layout& layout)
    : layout_(layout), file_(std::move(path)) {}

void Rays::write(const world::State& state) {
  for (const world::Ray& ray : state.rays) {
    v1::RayLine line = line_of(state, name_of(ray.kind), layout_.robots[ray.robot].id);
    line.mutable_start()->Add(ray.start.begin(), ray.start.end());
    line.mutable_end()->Add(ray.end.begin(), ray.end.end());
    line.set_hit(ray.hit);
    write(line);
  }
  for (const world::Frustum& frustum : state.frusta) {
    v1::RayLine line = line_of(state, "frustum", robot_with(frustum.camera, layout_).id);
    line.set_camera(v1::valid_utf8(layout_.cameras[frustum.camera].id));
    for (const math::Vector3& corner : frustum.corners) {
      line.mutable_corners()->Add(corner.begin(), corner.end());
    }
    write(line);
  }
}

void Rays::write(const v1::RayLine& line) {
  write_json(line, file_);
  file_.buffer().push_back('\n');
  file_.written();
}

}  // namespace ziggurat::outputs
