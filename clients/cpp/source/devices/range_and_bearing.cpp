// SPDX-License-Identifier: MIT
#include "layout.h"

namespace ziggurat {
namespace {

/// The packets that robots receive.
class PacketChannel final : public Channel {
 public:
  using Packets = std::vector<RangeAndBearing::Packet>;

  /// Adds the packets of the next robot; null if it receives none.
  void add(Packets* packets) { packets_.push_back(packets); }

  void check(const v1::Observation& from) const override {
    for (const v1::RangeAndBearingPacket& packet : from.range_and_bearing()) {
      if (packet.robot() < packets_.size() && packets_[packet.robot()] != nullptr) continue;
      throw std::runtime_error("the server sent a range-and-bearing packet for robot " +
                               std::to_string(packet.robot()) + ", which receives none");
    }
  }
  void read(const v1::Observation& from) override {
    for (Packets* packets : packets_) {
      if (packets != nullptr) packets->clear();
    }
    for (const v1::RangeAndBearingPacket& packet : from.range_and_bearing()) {
      packets_[packet.robot()]->push_back({packet.range(), packet.horizontal_bearing(),
                                           packet.vertical_bearing(), bytes_of(packet.data())});
    }
  }

 private:
  std::vector<Packets*> packets_;
};

/// The data that robots broadcast, one behind the other.
class DataChannel final : public Channel {
 public:
  /// Before the data are handed out.
  void resize(std::size_t bytes) { data_.resize(bytes); }
  std::span<std::uint8_t> next(std::size_t bytes) {
    used_ += bytes;
    return std::span(data_).subspan(used_ - bytes, bytes);
  }
  bool& changed() { return changed_; }

  void write(v1::Command& to) override {
    if (changed_) to.mutable_range_and_bearing_data()->assign(data_.begin(), data_.end());
  }
  void sent() override { changed_ = false; }
  void repeat() override { changed_ = true; }
  void load(v1::Command& from) override {
    const std::string& data = from.range_and_bearing_data();
    if (data.size() == data_.size()) std::copy(data.begin(), data.end(), data_.begin());
  }
  void reset() override {
    std::fill(data_.begin(), data_.end(), std::uint8_t{0});
    changed_ = false;
  }

 private:
  std::vector<std::uint8_t> data_;
  std::size_t used_ = 0;
  bool changed_ = false;
};

/// The number decides how much memory is allocated.
void check_size(const v1::RobotDescription& robot) {
  constexpr std::uint32_t max_bytes = 65'536;  // of a packet, as in scenes
  const std::uint32_t bytes = robot.range_and_bearing().data_size();
  if (bytes <= max_bytes) return;
  throw std::runtime_error("the server announced range-and-bearing packets of " +
                           std::to_string(bytes) + " bytes for robot '" + robot.id() +
                           "'; at most " + std::to_string(max_bytes) + " are allowed");
}

void check_sends(const RangeAndBearing& device) {
  if (device.sends()) return;
  throw std::logic_error(
      "the robot has no range-and-bearing actuator: the controller's <actuators> do not list it");
}

}  // namespace

void Layout::add_range_and_bearing() {
  auto& packets = add(PacketChannel());
  auto& data = add(DataChannel());
  std::size_t bytes = 0;
  for (const v1::RobotDescription& robot : welcome.robots()) {
    check_size(robot);
    if (robot.range_and_bearing().sends()) bytes += robot.range_and_bearing().data_size();
  }
  data.resize(bytes);
  each_robot([&](const v1::RobotDescription& robot, Robot& to) {
    const v1::RangeAndBearingDescription& from = robot.range_and_bearing();
    if (!robot.has_range_and_bearing()) return packets.add(nullptr);
    RangeAndBearing& device = to.range_and_bearing_.emplace();
    device.range_ = from.range();
    device.data_size_ = from.data_size();
    device.receives_ = from.receives();
    packets.add(from.receives() ? &device.packets_ : nullptr);
    if (!from.sends()) return;
    device.data_ = data.next(device.data_size_);
    device.changed_ = &data.changed();
  });
}

void RangeAndBearing::set_data(Bytes data) {
  check_sends(*this);
  if (data.size() != data_size_) {
    throw std::invalid_argument("range-and-bearing data of " + std::to_string(data.size()) +
                                " bytes; this robot sends packets of " +
                                std::to_string(data_size_));
  }
  std::copy(data.begin(), data.end(), data_.begin());
  *changed_ = true;
}

void RangeAndBearing::clear_data() {
  check_sends(*this);
  std::fill(data_.begin(), data_.end(), std::uint8_t{0});
  *changed_ = true;
}

}  // namespace ziggurat
