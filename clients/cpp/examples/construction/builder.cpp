// SPDX-License-Identifier: MIT
#include "builder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "tag_pose.h"

namespace construction {
namespace {

// Dimensions of the robot [m]. It does not know the positions of the blocks.
constexpr double wheel_radius = 0.025, half_track = 0.052;
// Rotation of the wheels / rotation of the robot, as they skid: without a block, and with one.
constexpr double slip[] = {1.335, 1.12};
constexpr double front_sensor = 0.065;  // position of the front proximity sensors
constexpr double tag_side = 0.024;
constexpr std::size_t sensors = 16;  // for proximity

constexpr double infinity = std::numeric_limits<double>::infinity();

// The proximity sensors' calibration: distance [m] and counts.
struct Point {
  double distance, counts;
};
constexpr Point calibration[] = {{0.0035, 65535}, {0.005, 32000}, {0.0075, 14222}, {0.01, 8000},
                                 {0.015, 3556},   {0.02, 2000},   {0.03, 889},     {0.04, 500},
                                 {0.06, 222},     {0.08, 125},    {0.1, 80},       {0.15, 36},
                                 {0.2, 20}};

/// Turn rate that moves the robot onto the line in front of a face with a distance constant of 3
/// cm, forwards or backwards [rad/s].
/// @param pivot  the point about which it turns, if it is known, so far in front of its centre [m]:
/// that
///               point moves there, sooner where it drives slowly
double steer(const Face& face, double speed, std::optional<double> pivot = {}) {
  const double settle = pivot ? std::max(0.018, 0.6 * speed) : 0.03;
  const double wanted = std::clamp(face.offset(pivot.value_or(0)) / (2 * settle), -0.25, 0.25);
  return std::abs(speed) * 2 / settle * (face.heading - (speed > 0 ? wanted : -wanted));
}

/// The color of the LEDs around a tag; none if they are off. They are 20 mm from the tag's centre,
/// in both directions; farther out are those of the neighbouring faces.
std::optional<ziggurat::Color> color_around(const TagPose& tag, const ziggurat::Camera& camera) {
  const auto& [centre, normal] = tag;
  const double along = centre[0] * normal[0] + centre[1] * normal[1] + centre[2] * normal[2];
  constexpr double most = 0.024;
  for (const ziggurat::Camera::LedReading& led : camera.directional_leds()) {
    const double x = (led.center[0] - camera.principal_point()[0]) / camera.focal_length()[0];
    const double y = (led.center[1] - camera.principal_point()[1]) / camera.focal_length()[1];
    const double depth = along / (x * normal[0] + y * normal[1] + normal[2]);  // ray meets face
    const double dx = x * depth - centre[0], dy = y * depth - centre[1], dz = depth - centre[2];
    if (std::abs(dy) < most && dx * dx + dz * dz < most * most) return led.color;
  }
  return std::nullopt;
}

}  // namespace

double Face::offset(double ahead) const {
  return (forward - ahead) * std::sin(heading) - left * std::cos(heading);
}

bool is_at_floor_level(const Face& face) { return std::abs(face.up) < 0.02; }

Builder::Builder(ziggurat::Robot& robot)
    : camera_(robot.camera("camera")),
      left_wheels_{&robot.joint("base_wheel_fl"), &robot.joint("base_wheel_bl")},
      right_wheels_{&robot.joint("base_wheel_fr"), &robot.joint("base_wheel_br")},
      lift_(robot.joint("lift")),
      radio_(robot.radio("nfc")),
      magnets_(robot.magnets()),
      proximity_(robot.proximity_sensors()) {
  if (proximity_.size() >= sensors) return;
  throw std::runtime_error("robot '" + robot.id() + "' has " + std::to_string(proximity_.size()) +
                           " proximity sensors; the construction robot has " +
                           std::to_string(sensors));
}

void Builder::drive(double speed, double turn) {
  const double skid = turn * half_track * slip[loaded];
  for (ziggurat::Joint* wheel : left_wheels_) wheel->set_target((speed - skid) / wheel_radius);
  for (ziggurat::Joint* wheel : right_wheels_) wheel->set_target((speed + skid) / wheel_radius);
}

double Builder::speed() const {
  const double sum = left_wheels_[0]->encoder() + left_wheels_[1]->encoder() +
                     right_wheels_[0]->encoder() + right_wheels_[1]->encoder();
  return sum / 4 * wheel_radius;
}

bool Builder::lift_to(double height, double speed) {
  lift_height_ = height;
  lift_speed_limit_ = speed;
  return std::abs(height - lift_.encoder()) < 3e-4;
}

void Builder::move_lift() {
  constexpr double change = 0.015;  // in a step [m/s]
  const double wanted =
      std::clamp(3 * (lift_height_ - lift_.encoder()), -lift_speed_limit_, lift_speed_limit_);
  lift_speed_ = std::clamp(wanted, lift_speed_ - change, lift_speed_ + change);
  lift_.set_target(lift_speed_);
}

void Builder::set_current(double current) {
  for (ziggurat::Magnet& magnet : magnets_) magnet.set_current(current);
}

double Builder::distance(std::size_t sensor) const {
  const double reading = proximity_[sensor - 1].reading();
  for (std::size_t i = 1; i < std::size(calibration); ++i) {
    const Point near = calibration[i - 1], far = calibration[i];
    if (reading < far.counts) continue;
    const double share =
        (near.counts - std::min(reading, near.counts)) / (near.counts - far.counts);
    return near.distance + share * (far.distance - near.distance);
  }
  return infinity;
}

// The sensor is 4 mm inside of the face.
double Builder::below() const { return distance(13) - 0.004; }

double Builder::ahead() const {
  return front_sensor + std::min({distance(1), distance(2), distance(12)});
}

bool Builder::holds() const {
  return std::max({distance(13), distance(15), distance(16)}) < 0.0045;
}

std::vector<Face> Builder::faces() const {
  std::vector<Face> found;
  for (const ziggurat::Camera::TagReading& tag : camera_.tags()) {
    const std::optional<TagPose> pose = tag_pose(tag.corners, camera_, tag_side);
    if (!pose || !(std::abs(pose->normal[1]) < 0.3)) continue;
    const auto& [centre, normal] = *pose;
    found.push_back({.forward = centre[2] + camera_.position()[0],
                     .left = -centre[0],
                     .heading = std::atan2(normal[0], -normal[2]),
                     .up = -centre[1],
                     .payload = tag.payload,
                     .color = color_around(*pose, camera_)});
  }
  std::ranges::sort(found, {}, [](const Face& face) { return std::pair(face.forward, face.left); });
  return found;
}

std::optional<Face> Builder::nearest_face() const {
  for (const Face& face : faces()) {
    if (is_at_floor_level(face) && std::abs(face.heading) < 0.7) return face;
  }
  return std::nullopt;
}

/// The face that it drives to; none if it is not in the image.
/// @param another  whether the nearest is another one, farther away
std::optional<Face> Builder::tracked_face(bool& another) {
  const std::optional<Face> face = nearest_face();
  another = face && face->forward > tracked_ + 0.05;
  if (another) return std::nullopt;
  if (face) tracked_ = face->forward;
  return face;
}

void Builder::forget_face() { tracked_ = std::numeric_limits<double>::infinity(); }

Docking Builder::dock(double fastest) {
  bool another = false;
  const std::optional<Face> face = tracked_face(another);
  unseen_ = face ? 0 : unseen_ + 1;
  if (!face) {
    stop();
    if (another) return Docking::askew;
    if (unseen_ <= 5) return Docking::under_way;
    forget_face();
    return Docking::lost;
  }
  const double to_go = face->forward - reach;
  if (to_go < 0.15 && std::abs(face->offset()) > 0.01 + 0.5 * to_go) return Docking::askew;
  const Docking outcome = dock_at(*face, fastest, Ranging::proximity);
  if (outcome == Docking::docked) forget_face();
  return outcome;
}

Docking Builder::dock_at(const Face& face, double fastest, Ranging ranging, double distance,
                         std::optional<double> pivot) {
  const double to_go =
      (ranging == Ranging::proximity ? std::min(face.forward, ahead()) : face.forward) - distance;
  if (to_go < 0.03 && (std::abs(face.offset()) > 0.006 || std::abs(face.heading) > 0.12)) {
    stop();
    return Docking::askew;
  }
  if (to_go < 0.0005) {
    stop();
    return Docking::docked;
  }
  const double speed = std::max(0.008, std::min(fastest, 1.2 * to_go));
  drive(speed, steer(face, speed, pivot));
  return Docking::under_way;
}

bool Builder::back_away(double speed) {
  tracked_ += speed * tick;
  bool another = false;
  const std::optional<Face> face = tracked_face(another);
  drive(-speed, face ? steer(*face, -speed) : 0);
  if (!face || std::min(face->forward, ahead()) < 0.2) return false;
  return std::abs(face->offset()) < 0.15 * (face->forward - 0.1) || face->forward > 0.5;
}

}  // namespace construction
