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

  /// Rays of several robots are cast at once, by the threads of the physics.
  void sense(Tick& tick) override {
    constexpr std::size_t block = 8;  // robots that a thread takes at once
    dynamics::Team* const team = tick.physics.team();
    rays_.resize(sensors_.size());
    candidates_.resize(team ? team->size() : 1);
    dynamics::share_in_blocks(team, robots_.size(), block, [&](std::size_t i, unsigned member) {
      cast(tick, robots_[i], candidates_[member]);
    });
    for (Robot& robot : robots_) read(tick, robot);
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

  /// Casts the rays of a robot's sensors. It changes nothing of other robots.
  void cast(const Tick& tick, const Robot& robot, physics::Candidates& candidates) {
    const world::RobotLayout& layout = tick.layout.robots[robot.index];
    if (tick.state.is_absent(layout.entity)) return;
    const std::array own{layout.entity};
    math::Vector3 low = math::Vector3::Constant(HUGE_VAL), high = -low;
    for (std::size_t i = layout.proximity.begin; i < layout.proximity.end(); ++i) {
      const world::ProximityLayout& place = tick.layout.proximity[i];
      const math::Pose start = world::pose_of(tick.state, place.mount);
      const math::Vector3 way = start.orientation * place.direction;
      rays_[i].start = start.position;
      rays_[i].end = start.position + place.range * way;
      low = low.cwiseMin(rays_[i].start).cwiseMin(rays_[i].end);
      high = high.cwiseMax(rays_[i].start).cwiseMax(rays_[i].end);
    }
    tick.rays.find(low, high, own, candidates);
    for (std::size_t i = layout.proximity.begin; i < layout.proximity.end(); ++i) {
      Ray& ray = rays_[i];
      ray.hit = tick.rays.cast({ray.start, ray.end, own, sensors_[i].sees_floor}, candidates);
    }
  }

  void read(Tick& tick, Robot& robot) {
    const world::RobotLayout& layout = tick.layout.robots[robot.index];
    if (tick.state.is_absent(layout.entity)) return;
    for (std::size_t i = layout.proximity.begin; i < layout.proximity.end(); ++i) {
      const Sensor& sensor = sensors_[i];
      const auto& [start, end, hit] = rays_[i];
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

  struct Ray {
    math::Vector3 start, end;
    std::optional<physics::RayHit> hit;
  };

  std::vector<Sensor> sensors_;                  // parallel to Layout::proximity
  std::vector<Ray> rays_;                        // of each sensor
  std::vector<Robot> robots_;                    // that have sensors
  std::vector<physics::Candidates> candidates_;  // of each thread: of the robot under way
};

}  // namespace

std::unique_ptr<Kind> make_proximity() { return std::make_unique<Proximity>(); }

}  // namespace ziggurat::devices
