// SPDX-License-Identifier: MIT
// Inertial measurement units: an accelerometer and a gyroscope. They sample each substep; a reading
// is the mean over the tick, plus bias and noise.

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "devices/kind.h"
#include "math/archive.h"
#include "math/random.h"

namespace ziggurat::devices {
namespace {

/// Velocity and orientation of a sensor's frame.
struct SensorMotion {
  math::Vector3 velocity = math::Vector3::Zero();               // of its origin, in W [m/s]
  math::Vector3 angular_velocity = math::Vector3::Zero();       // in W [rad/s]
  math::Quaternion orientation = math::Quaternion::Identity();  // sensor to W
};

math::Vector3 draw(math::RandomStream& random, double deviation) {
  math::Vector3 values = math::Vector3::Zero();
  if (deviation == 0) return values;
  for (double& value : values) value = random.gaussian(0, deviation);
  return values;
}

std::array<double, 3> array_of(const math::Vector3& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

class Imus final : public Kind {
 public:
  std::unique_ptr<Kind> clone() const override { return std::make_unique<Imus>(*this); }

  void lay_out(const Carrier& carrier, world::RobotLayout& robot,
               world::Layout& layout) const override {
    robot.imus = append(carrier.enabled.imus, layout.imus, [&](const scene::Imu& imu) {
      return world::ImuLayout{imu.id, carrier.mount(carrier.anchor(imu.anchor), imu.pose, layout)};
    });
  }

  void add(const Setting& setting) override {
    tick_length_ = setting.tick_length;
    substep_ = setting.substep;
    gravity_ = {0, 0, -setting.scene.physics.gravity.value_or(0)};
    for (const world::RobotLayout& robot : setting.new_robots()) {
      const std::size_t links = setting.layout.entities[robot.entity].links.begin;
      const std::size_t origin = links + setting.entity(robot.entity).reference_link;
      for (std::size_t i = 0; i < robot.imus.count; ++i) {
        const world::ImuLayout& imu = setting.layout.imus[robot.imus.begin + i];
        sensors_.push_back({setting.enabled(robot).imus[i], imu.mount.link.value_or(origin),
                            math::RandomStream(setting.seed, "imus/" + robot.id + "/" + imu.id)});
      }
    }
  }

  /// New ones read what they feel at rest, without noise.
  void start(Tick& tick) override {
    for (std::size_t i = tick.observations.imus.size(); i < sensors_.size(); ++i) {
      const SensorMotion motion = motion_of(tick.state, sensors_[i], tick.layout.imus[i].mount);
      tick.observations.imus.push_back(
          {array_of(motion.orientation.conjugate() * -gravity_), {0, 0, 0}});
    }
  }

  void apply(Tick& tick) override {  // a supervisor may have moved the entity
    samples_ = 0;
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      sensors_[i].motion = motion_of(tick.state, sensors_[i], tick.layout.imus[i].mount);
      sensors_[i].force.setZero();
      sensors_[i].turning.setZero();
    }
  }

  // An accelerometer feels all forces but gravity: f = R^T (dv/dt - g), R from its frame to the
  // world (Titterton and Weston, Strapdown Inertial Navigation Technology, 2nd edition,
  // section 3.5). R is that in the middle of the substep, where the difference of two velocities
  // belongs.
  bool follows_substeps() const override { return true; }
  void after_substep(Tick& tick) override {
    ++samples_;
    std::size_t read = tick.layout.entities.size();
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      Sensor& sensor = sensors_[i];
      const world::Mount& mount = tick.layout.imus[i].mount;
      if (tick.state.is_absent(mount.entity)) continue;
      if (read != mount.entity) tick.physics.read(mount.entity, now_);
      read = mount.entity;
      const SensorMotion before = sensor.motion;
      sensor.motion = motion_of(now_, sensor, mount);
      const math::Quaternion middle = before.orientation.slerp(0.5, sensor.motion.orientation);
      sensor.force +=
          middle.conjugate() * ((sensor.motion.velocity - before.velocity) / substep_ - gravity_);
      sensor.turning += sensor.motion.orientation.conjugate() * sensor.motion.angular_velocity;
    }
  }

  void sense(Tick& tick) override {
    const double root = std::sqrt(tick_length_);
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      Sensor& sensor = sensors_[i];
      if (tick.state.is_absent(tick.layout.imus[i].mount.entity)) continue;
      const scene::Imu& imu = sensor.settings;
      sensor.force_bias += draw(sensor.random, imu.acceleration_bias_walk * root);
      sensor.turning_bias += draw(sensor.random, imu.angular_velocity_bias_walk * root);
      const math::Vector3 force = sensor.force / samples_ + sensor.force_bias;
      const math::Vector3 turning = sensor.turning / samples_ + sensor.turning_bias;
      tick.observations.imus[i] = {
          array_of(force + draw(sensor.random, imu.acceleration_noise)),
          array_of(turning + draw(sensor.random, imu.angular_velocity_noise))};
    }
  }

  /// The samples of a tick begin anew in each.
  void archive(math::Archive& archive) override {
    for (Sensor& sensor : sensors_) {
      archive("random", sensor.random);
      archive("force_bias", sensor.force_bias);
      archive("turning_bias", sensor.turning_bias);
    }
  }

 private:
  struct Sensor {
    scene::Imu settings;
    std::size_t link = 0;  // that it moves with, into State::links
    math::RandomStream random;
    SensorMotion motion = {};                            // at the last sample
    math::Vector3 force = math::Vector3::Zero();         // sum of all samples [m/s^2]
    math::Vector3 turning = math::Vector3::Zero();       // likewise [rad/s]
    math::Vector3 force_bias = math::Vector3::Zero();    // [m/s^2]
    math::Vector3 turning_bias = math::Vector3::Zero();  // [rad/s]
  };

  static SensorMotion motion_of(const world::State& state, const Sensor& sensor,
                                const world::Mount& mount) {
    const world::LinkState& link = state.links[sensor.link];
    const math::Pose pose = world::pose_of(state, mount);
    const math::Vector3 arm = pose.position - link.pose.position;
    return {link.velocity + link.angular_velocity.cross(arm), link.angular_velocity,
            pose.orientation};
  }

  double tick_length_ = 0;                         // simulated [s]
  double substep_ = 0;                             // physical [s]
  math::Vector3 gravity_ = math::Vector3::Zero();  // acceleration of free fall, in W [m/s^2]
  unsigned samples_ = 0;                           // in this tick
  std::vector<Sensor> sensors_;                    // parallel to Layout::imus
  world::State now_;                               // of their entities, at a substep's end
};

}  // namespace

std::unique_ptr<Kind> make_imus() { return std::make_unique<Imus>(); }

}  // namespace ziggurat::devices
