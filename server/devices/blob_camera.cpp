// SPDX-License-Identifier: MIT
// Coloured-blob cameras: the lit LEDs and lights of a medium that they see, of other entities. They
// see nothing until they are switched on, and keep what they saw when they are switched off.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "devices/described.h"

namespace ziggurat::devices {
namespace {

constexpr std::size_t most_blobs = 10'000;

constexpr world::DeviceKind omnidirectional{
    .name = "colored_blob_omnidirectional_camera",
    .readings = {{"distance", "m"}, {"angle", "rad"}, {"color", world::color_unit}},
    .commands = {{"enabled", "", 0, 1}},
    .properties = {{"aperture", "rad"}},
    .most_rows = most_blobs};
constexpr world::DeviceKind perspective{
    .name = "colored_blob_perspective_camera",
    .readings = {{"x", "px"}, {"y", "px"}, {"color", world::color_unit}},
    .commands = {{"enabled", "", 0, 1}},
    .properties = {{"aperture", "rad"}, {"focal_length", "m"}, {"range", "m"}},
    .most_rows = most_blobs};

/// A camera at one tick.
struct Eye {
  const math::Pose& pose;             // X_WC
  const std::vector<double>& optics;  // its properties
  math::RandomStream& random;
  double noise;
};

/// A point as a camera reads it; the line of sight is not checked.
using Blob = std::optional<std::array<double, 2>>;

/// Half the side of the square on the ground that a camera looking down sees [m].
double half_side(double height, double aperture) { return height * std::tan(aperture); }

class BlobCameras : public Described {
 public:
  using Described::Described;

  bool casts_rays() const final { return !robots().empty(); }
  bool needs_index() const final { return !robots().empty(); }

 private:
  /// Half the side of the box around the camera that holds all it can see [m].
  virtual double reach(const Eye& eye) const = 0;
  virtual Blob project(const Eye& eye, const math::Vector3& point) const = 0;
  /// Adds noise to what is seen.
  virtual void disturb(const Eye&, std::array<double, 2>&) const {}

  std::vector<double> properties(const scene::DevicePlace& place) const final {
    return place.settings;
  }

  void read(Tick& tick, Robot& robot) final {
    for (std::size_t i = 0; i < robot.devices.count; ++i) {
      const world::DescribedDevice& device = tick.layout.described[robot.devices.begin + i];
      const bool is_on =
          device.commands.count > 0 && tick.commands.device_commands[device.commands.begin] >= 0.5;
      if (is_on) look(tick, robot, device);
    }
  }

  void look(Tick& tick, Robot& robot, const world::DescribedDevice& device) {
    world::DeviceRows& rows = tick.observations.device_rows[device.rows.begin];
    rows.values.clear();
    const math::Pose pose = world::pose_of(tick.state, device.mount);
    const Eye eye{pose, device.properties, robot.random, robot.use.noise};
    const math::Vector3 half = math::Vector3::Constant(reach(eye));
    tick.index.find(tick.index.leds, pose.position - half, pose.position + half, found_);
    for (const std::size_t led : found_) {
      const world::LedLayout& layout = tick.layout.leds[led];
      const world::Color color = tick.state.led_colors[led];
      const bool is_other = layout.mount.entity != device.mount.entity;
      if (color == 0 || !is_other || layout.medium != robot.use.medium) continue;
      const math::Vector3& point = tick.index.position(tick.index.leds, led);
      Blob blob = project(eye, point);
      if (!blob || !sees(tick, robot, device, pose.position, point)) continue;
      disturb(eye, *blob);
      rows.values.insert(rows.values.end(), {(*blob)[0], (*blob)[1], static_cast<double>(color)});
      if (rows.count() == most_blobs) return;
    }
  }

  bool sees(Tick& tick, const Robot& robot, const world::DescribedDevice& device,
            const math::Vector3& eye, const math::Vector3& point) const {
    tick.take_line();
    constexpr double at_target = 1e-4;  // LEDs may be mounted flush [m]
    const std::array own{device.mount.entity};
    auto hit = tick.rays.cast({eye, point, own, false});
    if (hit && hit->distance >= (point - eye).norm() - at_target) hit.reset();
    tick.show({world::Ray::Kind::device, robot.index, eye, point}, hit, robot.use.show_rays);
    return !hit;
  }

  std::vector<std::size_t> found_;
};

/// Looks down from above its robot, all around: distance and direction over the ground.
class Omnidirectional final : public BlobCameras {
 public:
  Omnidirectional() : BlobCameras(omnidirectional) {}
  std::unique_ptr<Kind> clone() const override { return std::make_unique<Omnidirectional>(*this); }

 private:
  double sight(const scene::DevicePlace& place) const override {
    return half_side(place.pose.position.z(), place.settings[0]);
  }

  double reach(const Eye& eye) const override {
    const double height = eye.pose.position.z();
    return std::max(height, half_side(height, eye.optics[0]));
  }

  /// Seen are points below the camera, in a square along the axes of the world.
  Blob project(const Eye& eye, const math::Vector3& point) const override {
    const math::Vector3 away = point - eye.pose.position;
    const double half = half_side(eye.pose.position.z(), eye.optics[0]);
    if (std::abs(away.x()) >= half || std::abs(away.y()) >= half || away.z() >= 0) return {};
    const math::Vector3 seen = eye.pose.orientation.conjugate() * away;
    return {{std::hypot(seen.x(), seen.y()), std::atan2(seen.y(), seen.x())}};
  }

  /// Noise is a share of the distance: its length is normal, its direction uniform.
  void disturb(const Eye& eye, std::array<double, 2>& blob) const override {
    if (eye.noise == 0) return;
    const double length = blob[0] * eye.random.gaussian(0, eye.noise);
    const double direction = eye.random.uniform(0, 2 * std::numbers::pi);
    const double x = blob[0] * std::cos(blob[1]) + length * std::cos(direction);
    const double y = blob[0] * std::sin(blob[1]) + length * std::sin(direction);
    blob = {std::hypot(x, y), std::atan2(y, x)};
  }
};

/// Looks along +x of its place: whole pixels from the top left of a picture.
class Perspective final : public BlobCameras {
 public:
  Perspective() : BlobCameras(perspective) {}
  std::unique_ptr<Kind> clone() const override { return std::make_unique<Perspective>(*this); }

 private:
  static constexpr double width = 640, height = 480;  // [px]

  static double farthest(const std::vector<double>& optics) {
    return optics[2] / std::cos(optics[0]);
  }
  double sight(const scene::DevicePlace& place) const override { return farthest(place.settings); }
  double reach(const Eye& eye) const override { return farthest(eye.optics); }

  /// The aperture is the angle from the axis to a corner of the picture.
  Blob project(const Eye& eye, const math::Vector3& point) const override {
    const double aperture = eye.optics[0], focal_length = eye.optics[1], range = eye.optics[2];
    const math::Vector3 seen = eye.pose.orientation.conjugate() * (point - eye.pose.position);
    if (!(seen.x() > 0 && seen.x() < range)) return {};
    if (std::atan2(std::hypot(seen.y(), seen.z()), seen.x()) >= aperture) return {};
    const double picture =  // its height [m]
        2 * focal_length * std::tan(aperture) / std::hypot(1.0, width / height);
    const double pixels = focal_length * height / picture;  // of a slope of 1
    const double x = std::trunc(width / 2 - seen.y() / seen.x() * pixels);
    const double y = std::trunc(height / 2 - seen.z() / seen.x() * pixels);
    if (x < 0 || x >= width || y < 0 || y >= height) return {};
    return {{x, y}};
  }
};

}  // namespace

std::unique_ptr<Kind> make_omnidirectional_camera() { return std::make_unique<Omnidirectional>(); }
std::unique_ptr<Kind> make_perspective_camera() { return std::make_unique<Perspective>(); }

}  // namespace ziggurat::devices
