#include "recording/rays.h"

#include <utility>

#include "recording/json.h"
#include "ziggurat/v1/envelope.h"
#include "ziggurat/v1/recording.pb.h"

namespace ziggurat::recording {
namespace {

const char* name_of(world::Ray::Kind kind) {
  switch (kind) {
    case world::Ray::Kind::proximity:
      return "proximity";
    case world::Ray::Kind::radio:
      return "radio";
    case world::Ray::Kind::range_and_bearing:
      return "range_and_bearing";
  }
  return "";
}

}  // namespace

Rays::Rays(std::string path, const world::Layout& layout)
    : layout_(layout), file_(std::move(path)) {}

void Rays::write(const world::State& state) {
  for (const world::Ray& ray : state.rays) {
    v1::RayLine line;
    line.set_tick(state.tick);
    line.set_time_s(static_cast<double>(state.time_ns) / 1e9);
    line.set_kind(name_of(ray.kind));
    line.set_robot(v1::valid_utf8(layout_.robots[ray.robot].id));
    line.mutable_start()->Add(ray.start.begin(), ray.start.end());
    line.mutable_end()->Add(ray.end.begin(), ray.end.end());
    line.set_hit(ray.hit);
    file_.buffer().append(to_json(line));
    file_.buffer().push_back('\n');
    file_.written();
  }
}

}  // namespace ziggurat::recording
