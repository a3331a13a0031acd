// SPDX-License-Identifier: MIT
// Distance scanner of the foot-bot: a head that turns about z, with two beams of short and two of
// long range, a right angle apart.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "devices/described.h"
#include "math/archive.h"

namespace ziggurat::devices {
namespace {

/// Places of the commands.
enum Place : std::size_t { mode_at, angle_at, speed_at };
enum class Mode { off, position, speed };

constexpr world::DeviceKind distance_scanner{
    .name = "footbot_distance_scanner",
    .readings = {{"angle", "rad"}, {"distance", "m"}, {"is_long"}},
    .commands = {{"mode", "", 0, 2}, {"angle", "rad"}, {"speed", "rad/s"}},
    .most_rows = 24};

struct Beam {
  double bearing;      // from the head's angle [rad]
  double least, most;  // distances [m]
  bool is_long;
};
constexpr double quarter = std::numbers::pi / 2;
constexpr std::array<Beam, 4> beams{{{0, 0, 0.26, false},
                                     {2 * quarter, 0, 0.26, false},
                                     {quarter, 0.12, 1.42, true},
                                     {-quarter, 0.12, 1.42, true}}};

// Distances that are none [m].
constexpr double too_near = -0.01, nothing = -0.02;

constexpr unsigned rays_per_beam = 6;  // in mode speed, over the turn in a tick

class DistanceScanner final : public Described {
 public:
  DistanceScanner() : Described(distance_scanner) {}
  std::unique_ptr<Kind> clone() const override { return std::make_unique<DistanceScanner>(*this); }

  bool casts_rays() const override { return !heads_.empty(); }

  void apply(Tick& tick) override {
    for (std::size_t i = 0; i < heads_.size(); ++i) {
      Head& head = heads_[i];
      const world::Range& commands = commands_of(tick, i);
      if (commands.count == 0) continue;
      const double* const command = &tick.commands.device_commands[commands.begin];
      head.mode = static_cast<Mode>(std::lround(command[mode_at]));
      head.turn = 0;
      if (head.mode == Mode::position) head.angle = command[angle_at];
      if (head.mode == Mode::speed) head.turn = command[speed_at] * tick_length_;
      head.angle = std::remainder(head.angle + head.turn, 2 * std::numbers::pi);
    }
  }

  void archive(math::Archive& archive) override {
    Described::archive(archive);
    for (Head& head : heads_) archive("angle", head.angle);
  }

 private:
  struct Head {
    Mode mode = Mode::off;
    double angle = 0;  // about z of the robot [rad]
    double turn = 0;   // in this tick [rad]
  };
  struct Row {
    double angle, distance, is_long;
  };

  const world::Range& commands_of(const Tick& tick, std::size_t robot) const {
    return tick.layout.described[robots()[robot].devices.begin].commands;
  }

  void add_others(const Setting& setting) override { tick_length_ = setting.tick_length; }
  void add_robot(const Setting&) override { heads_.emplace_back(); }

  void read(Tick& tick, Robot& robot) override {
    const Head& head = heads_[static_cast<std::size_t>(&robot - robots().data())];
    const world::DescribedDevice& device = tick.layout.described[robot.devices.begin];
    std::vector<double>& rows = tick.observations.device_rows[device.rows.begin].values;
    rows.clear();
    if (head.mode == Mode::off) return;
    const unsigned count = head.turn == 0 ? 1 : rays_per_beam;
    rows_.clear();
    for (const Beam& beam : beams) {
      for (unsigned i = 0; i < count; ++i) {
        const double at = head.angle - head.turn * (1 - static_cast<double>(i) / count);
        const double bearing =
            std::remainder((count == 1 ? head.angle : at) + beam.bearing, 2 * std::numbers::pi);
        rows_.push_back(
            {bearing, measure(tick, robot, device.mount, beam, bearing), beam.is_long ? 1.0 : 0.0});
      }
    }
    std::ranges::stable_sort(rows_, [](const Row& a, const Row& b) {
      return std::pair(a.is_long, a.angle) < std::pair(b.is_long, b.angle);
    });
    for (const Row& row : rows_) rows.insert(rows.end(), {row.angle, row.distance, row.is_long});
  }

  double measure(Tick& tick, const Robot& robot, const world::Mount& mount, const Beam& beam,
                 double bearing) const {
    const double radius = robot.places[0].settings[0];
    const math::Pose pose = world::pose_of(tick.state, mount);
    const math::Vector3 way =
        pose.orientation * math::Vector3(std::cos(bearing), std::sin(bearing), 0);
    const math::Vector3 start = pose.position + radius * way, end = start + beam.most * way;
    const std::array own{mount.entity};
    const auto hit = tick.rays.cast({start, end, own, false});
    tick.show({world::Ray::Kind::device, robot.index, start, end}, hit, robot.use.show_rays);
    if (!hit) return nothing;
    return hit->distance <= beam.least ? too_near : hit->distance;
  }

  double tick_length_ = 0;   // simulated [s]
  std::vector<Head> heads_;  // parallel to robots()
  std::vector<Row> rows_;    // of the robot under way
};

}  // namespace

std::unique_ptr<Kind> make_distance_scanner() { return std::make_unique<DistanceScanner>(); }

}  // namespace ziggurat::devices
