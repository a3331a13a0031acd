// SPDX-License-Identifier: MIT
// Messages of kilobots: nine bytes to all that are near, twice a second, with the distance.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "devices/described.h"
#include "math/archive.h"
#include "media/spatial_index.h"

namespace ziggurat::devices {
namespace {

constexpr std::size_t bytes = 9;
constexpr double period = 0.5;  // of sending: kilolib sends twice a second [s]

constexpr world::DeviceKind kilobot_communication{.name = "kilobot_communication",
                                                  .readings = {{"distance", "m"},
                                                               {"data_1"},
                                                               {"data_2"},
                                                               {"data_3"},
                                                               {"data_4"},
                                                               {"data_5"},
                                                               {"data_6"},
                                                               {"data_7"},
                                                               {"data_8"},
                                                               {"data_9"}},
                                                  .commands = {{"enabled", "", 0, 1},
                                                               {"data_1", "", 0, 255},
                                                               {"data_2", "", 0, 255},
                                                               {"data_3", "", 0, 255},
                                                               {"data_4", "", 0, 255},
                                                               {"data_5", "", 0, 255},
                                                               {"data_6", "", 0, 255},
                                                               {"data_7", "", 0, 255},
                                                               {"data_8", "", 0, 255},
                                                               {"data_9", "", 0, 255}},
                                                  .most_rows = 200};

/// Infrared light is reflected by the ground below the robots, so that bodies hide nothing. When a
/// robot sends is drawn once: at `phase` and every half second from then on.
class KilobotCommunication final : public Described {
 public:
  KilobotCommunication() : Described(kilobot_communication) {}
  std::unique_ptr<Kind> clone() const override {
    return std::make_unique<KilobotCommunication>(*this);
  }

  void apply(Tick&) override { knows_senders_ = false; }

  void archive(math::Archive& archive) override {
    Described::archive(archive);
    for (double& phase : phases_) archive("phase", phase);
  }

 private:
  void add_others(const Setting& setting) override { tick_length_ = setting.tick_length; }

  void add_robot(const Setting& setting) override {
    const std::string& id = setting.layout.robots[robots().back().index].id;
    math::RandomStream random(setting.seed, "kilobot_communication/phase/" + id);
    phases_.push_back(random.uniform(0, period));
    ranges_.push_back(robots().back().places[0].settings[0]);
  }

  void read(Tick& tick, Robot& robot) override {
    if (!knows_senders_) find_senders(tick);
    knows_senders_ = true;
    const std::size_t own = static_cast<std::size_t>(&robot - robots().data());
    const world::DescribedDevice& device = tick.layout.described[robot.devices.begin];
    std::vector<double>& rows = tick.observations.device_rows[device.rows.begin].values;
    rows.clear();
    if (senders_.empty()) return;
    const math::Vector3 ear = world::position_of(tick.state, device.mount);
    index_.find(ear, farthest_, 0, senders_.size(), near_);
    for (const std::size_t near : near_) {
      const Sender& sender = senders_[near];
      const double distance = (places_[near] - ear).norm();
      if (sender.robot == own || !(distance < ranges_[sender.robot]) ||
          robots()[sender.robot].use.medium != robot.use.medium)
        continue;
      for (unsigned i = 0; i < sender.messages; ++i) hear(tick, robot, sender, distance, rows);
    }
  }

  struct Sender {
    std::size_t robot;     // into robots()
    std::size_t commands;  // into Commands::device_commands
    unsigned messages;     // in this tick
  };

  /// Messages whose time is in the tick that ends now.
  unsigned messages(const Tick& tick, double phase) const {
    const double end = static_cast<double>(tick.state.tick) * tick_length_ - phase;
    const double start = static_cast<double>(tick.state.tick - 1) * tick_length_ - phase;
    return static_cast<unsigned>(std::floor(end / period) - std::floor(start / period));
  }

  void find_senders(const Tick& tick) {
    senders_.clear();
    places_.clear();
    farthest_ = 0;
    for (std::size_t i = 0; i < robots().size(); ++i) {
      const world::DescribedDevice& device = tick.layout.described[robots()[i].devices.begin];
      const bool is_absent = tick.state.is_absent(tick.layout.robots[robots()[i].index].entity);
      if (device.commands.count == 0 || is_absent) continue;
      const unsigned count = messages(tick, phases_[i]);
      const bool is_enabled = tick.commands.device_commands[device.commands.begin] > 0.5;
      if (count == 0 || !is_enabled) continue;
      senders_.push_back({i, device.commands.begin + 1, count});
      places_.push_back(world::position_of(tick.state, device.mount));
      farthest_ = std::max(farthest_, ranges_[i]);
    }
    if (!senders_.empty()) index_.build(places_, farthest_);
  }

  static void hear(const Tick& tick, Robot& robot, const Sender& sender, double distance,
                   std::vector<double>& rows) {
    if (robot.use.loss > 0 && robot.random.uniform(0, 1) < robot.use.loss) return;
    if (robot.use.noise > 0) distance += robot.random.gaussian(0, robot.use.noise);
    if (rows.size() >= kilobot_communication.most_rows * (bytes + 1)) return;
    rows.push_back(std::max(0.0, distance));
    for (std::size_t i = 0; i < bytes; ++i)
      rows.push_back(std::floor(tick.commands.device_commands[sender.commands + i]));
  }

  double tick_length_ = 0;             // [s]
  std::vector<double> phases_;         // of each robot [s]
  std::vector<double> ranges_;         // of each robot [m]
  bool knows_senders_ = false;         // those of the tick
  std::vector<Sender> senders_;        // in scene order
  std::vector<math::Vector3> places_;  // of the senders, in W [m]
  double farthest_ = 0;                // range of a sender [m]
  media::SpatialIndex index_;          // of the senders
  std::vector<std::size_t> near_;
};

}  // namespace

std::unique_ptr<Kind> make_kilobot_communication() {
  return std::make_unique<KilobotCommunication>();
}

}  // namespace ziggurat::devices
