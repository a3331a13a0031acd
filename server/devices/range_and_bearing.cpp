#include "devices/range_and_bearing.h"

#include <array>

namespace ziggurat::devices {

void RangeAndBearing::add(const Setting& setting) {
  const world::Layout& layout = setting.layout;
  receivers_.resize(layout.range_and_bearing.size());
  for (std::size_t r = setting.first_robot; r < layout.robots.size(); ++r) {
    const world::RobotLayout& robot = layout.robots[r];
    const scene::ControllerDevices& enabled = setting.enabled(robot);
    if (robot.range_and_bearing.count == 0 || !enabled.range_and_bearing_sensor) continue;
    const std::size_t device = robot.range_and_bearing.begin;
    const std::size_t medium = layout.range_and_bearing[device].medium;
    const bool occludes = setting.scene.media[medium].checks_occlusions;
    receivers_[device].emplace(
        Receiver{r, enabled.range_and_bearing_noise, enabled.range_and_bearing_loss,
                 enabled.range_and_bearing_show_rays, occludes,
                 math::RandomStream(setting.seed, "range_and_bearing/" + robot.id)});
    needs_index_ = true;
    casts_rays_ = casts_rays_ || occludes;
  }
}

void RangeAndBearing::sense(Tick& tick) {
  tick.observations.range_and_bearing.clear();
  if (!needs_index_) return;
  tick.observations.range_and_bearing_data = tick.state.range_and_bearing_data;
  for (const media::Sighting& pair : medium_.sight(tick.layout, tick.index)) {
    receive(tick, pair, *receivers_[pair.receiver]);
  }
}

void RangeAndBearing::receive(Tick& tick, const media::Sighting& pair, Receiver& receiver) {
  const auto& devices = tick.layout.range_and_bearing;
  const auto &from = devices[pair.sender], &to = devices[pair.receiver];
  const math::Pose own = world::pose_of(tick.state, to.mount);
  const math::Vector3 other = world::position_of(tick.state, from.mount);
  if (receiver.checks_occlusions) {
    // The two carriers are not in their own way.
    const std::array carriers{to.mount.entity, from.mount.entity};
    const auto hit = tick.rays.cast({other, own.position, carriers, false});
    if (receiver.shows_rays) {
      const math::Vector3 way = own.position - other;
      const math::Vector3 end =
          hit ? math::Vector3(other + way.normalized() * hit->distance) : own.position;
      tick.state.rays.push_back(
          {world::Ray::Kind::range_and_bearing, receiver.robot, other, end, hit.has_value()});
    }
    if (hit) return;
  } else if (receiver.shows_rays) {
    tick.state.rays.push_back(
        {world::Ray::Kind::range_and_bearing, receiver.robot, other, own.position, false});
  }
  if (receiver.loss > 0 && receiver.random.uniform(0, 1) < receiver.loss) return;
  math::Vector3 seen = math::inverse(own) * other;
  if (receiver.noise > 0) {
    for (double& coordinate : seen) coordinate += receiver.random.gaussian(0, receiver.noise);
  }
  const media::Bearing bearing = media::bearing_of(seen);
  tick.observations.range_and_bearing.push_back(
      {pair.receiver, bearing.range, bearing.horizontal, bearing.vertical, from.data});
}

}  // namespace ziggurat::devices
