// SPDX-License-Identifier: MIT
// Proximity sensors: rays that read how close the nearest foreign body is.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "devices/kind.h"
#include "math/archive.h"
#include "math/random.h"

namespace ziggurat::devices {
namespace {

double proximity_reading(double distance, const scene::Response* response) {
  if (!response) return std::exp(-distance);
  const auto& points = response->points;
  const auto next =
      std::ranges::upper_bound(points, distance, {}, &scene::Response::Point::distance);
  if (next == points.begin()) return points.front().reading;
  if (next == points.end()) return points.back().reading;
  const scene::Response::Point &near = *(next - 1), &far = *next;
  const double share = (distance - near.distance) / (far.distance - near.distance);
  return near.reading + share * (far.reading - near.reading);
}

double footbot_proximity_reading(double distance) {
  constexpr double saturated = 0.009889556;                     // [m]
  constexpr double strength = 0.0100527, offset = 0.000163144;  // [m]
  if (distance < saturated) return 1;
  return std::min(1.0, strength / (distance + offset));
}

class Proximity final : public Kind {
 public:
  std::unique_ptr<Kind> clone() const override { return std::make_unique<Proximity>(*this); }

  void lay_out(const Carrier& carrier, world::RobotLayout& robot,
               world::Layout& layout) const override {
    robot.proximity.begin = layout.proximity.size();
    const auto& use = carrier.enabled.proximity;
    if (!use) return;
    robot.proximity =
        append(carrier.entity.devices.proximity_sensors, layout.proximity, [&](const auto& sensor) {
          world::ProximityLayout ray{carrier.mount(sensor.anchor, sensor.offset, layout),
                                     sensor.direction,
                                     sensor.range,
                                     {}};
          if (use->footbot) ray.angle = std::atan2(sensor.direction.y(), sensor.direction.x());
          return ray;
        });
  }

  void add(const Setting& setting) override {
    for (std::size_t r = setting.first_robot; r < setting.layout.robots.size(); ++r) {
      const world::RobotLayout& robot = setting.layout.robots[r];
      if (robot.proximity.count == 0) continue;
      const scene::ProximityUse& use = *setting.enabled(robot).proximity;
      robots_.push_back(
          {r, use.noise, use.show_rays, math::RandomStream(setting.seed, "proximity/" + robot.id)});
      for (const auto& from : setting.entity(robot.entity).devices.proximity_sensors) {
        Sensor sensor;
        sensor.footbot = use.footbot;
        sensor.response = from.response ? from.response : use.response;
        sensor.sees_floor = from.sees_floor.value_or(use.sees_floor);
        if (sensor.response) {
          sensor.most = 0;
          for (const auto& point : sensor.response->points) {
            sensor.least = std::min(sensor.least, point.reading);
            sensor.most = std::max(sensor.most, point.reading);
          }
        }
        sensors_.push_back(std::move(sensor));
      }
    }
  }

  void start(Tick& tick) override { tick.observations.proximity.resize(sensors_.size(), 0); }

  void sense(Tick& tick) override {
    for (Robot& robot : robots_) sense(tick, robot);
  }

  bool casts_rays() const override { return !sensors_.empty(); }

  void archive(math::Archive& archive) override {
    for (Robot& robot : robots_) archive("random", robot.random);
  }

 private:
  struct Sensor {
    std::optional<scene::Response> response;
    bool footbot = false;  // has the foot-bot's own response
    bool sees_floor = false;
    double least = 0, most = 1;  // of readings with noise
  };
  struct Robot {
    std::size_t index;  // into Layout::robots
    double noise;       // uniform in ± this
    bool shows_rays;
    math::RandomStream random;
  };

  /// The rays of a robot's sensors, and what is near all of them.
  /// @param own  the robot's entity, which they ignore
  void aim(const Tick& tick, const world::Range& sensors, std::span<const std::size_t> own) {
    segments_.clear();
    math::Vector3 low = math::Vector3::Constant(HUGE_VAL), high = -low;
    for (std::size_t i = sensors.begin; i < sensors.end(); ++i) {
      const world::ProximityLayout& ray = tick.layout.proximity[i];
      const math::Pose start = world::pose_of(tick.state, ray.mount);
      const math::Vector3 way = start.orientation * ray.direction;
      const math::Vector3 end = start.position + ray.range * way;
      segments_.push_back({start.position, end});
      low = low.cwiseMin(start.position).cwiseMin(end);
      high = high.cwiseMax(start.position).cwiseMax(end);
    }
    tick.rays.find(low, high, own, candidates_);
  }

  void sense(Tick& tick, Robot& robot) {
    const world::RobotLayout& layout = tick.layout.robots[robot.index];
    if (tick.state.is_absent(layout.entity)) return;
    const std::array own{layout.entity};
    aim(tick, layout.proximity, own);
    for (std::size_t i = layout.proximity.begin; i < layout.proximity.end(); ++i) {
      const Sensor& sensor = sensors_[i];
      const auto& [start, end] = segments_[i - layout.proximity.begin];
      const auto hit = tick.rays.cast({start, end, own, sensor.sees_floor}, candidates_);
      double reading = 0;
      if (hit) {
        reading = sensor.footbot ? footbot_proximity_reading(hit->distance)
                                 : proximity_reading(hit->distance,
                                                     sensor.response ? &*sensor.response : nullptr);
      }
      if (robot.noise > 0) {
        reading += robot.random.uniform(-robot.noise, robot.noise);
        reading = std::clamp(reading, sensor.least, sensor.most);
      }
      tick.observations.proximity[i] = reading;
      tick.show({world::Ray::Kind::proximity, robot.index, start, end}, hit, robot.shows_rays);
    }
  }

  struct Segment {
    math::Vector3 start, end;
  };

  std::vector<Sensor> sensors_;     // parallel to Layout::proximity
  std::vector<Robot> robots_;       // that have sensors
  std::vector<Segment> segments_;   // of the robot under way
  physics::Candidates candidates_;  // of these
};

}  // namespace

std::unique_ptr<Kind> make_proximity() { return std::make_unique<Proximity>(); }

}  // namespace ziggurat::devices
