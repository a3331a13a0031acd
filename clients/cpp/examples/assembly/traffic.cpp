// SPDX-License-Identifier: MIT
#include "traffic.h"

#include <array>
#include <cmath>

namespace assembly {
namespace {

constexpr int dead = 50;  // ticks with the same bytes, after which a robot is an obstacle only
constexpr std::size_t packet_bytes = 3;
enum Flag : std::uint8_t { working = 1, asking = 2, holding = 4, stopped = 8, row = 16 };

Neighbour neighbour_of(const ziggurat::RangeAndBearing::Packet& packet, std::uint8_t flags) {
  const double range = packet.range * 100 / 100;  // a script gets centimetres
  const double bearing = packet.horizontal_bearing;
  return {.forward = range * std::cos(bearing),
          .left = range * std::sin(bearing),
          .range = range,
          .working = (flags & working) != 0,
          .asking = (flags & asking) != 0,
          .holding = (flags & holding) != 0,
          .stopped = (flags & stopped) != 0,
          .row = static_cast<std::uint8_t>(flags / row),
          .claim = packet.data[1]};
}

}  // namespace

void sense(Traffic& traffic, const ziggurat::RangeAndBearing& device) {
  traffic.neighbours.clear();
  std::map<std::vector<std::uint8_t>, int> now;
  for (const auto& packet : device.packets()) {
    if (packet.data.size() != packet_bytes) continue;
    const std::vector<std::uint8_t> bytes(packet.data.begin(), packet.data.end());
    const auto before = traffic.unchanged.find(bytes);
    const int ticks = before == traffic.unchanged.end() ? 1 : before->second + 1;
    now[bytes] = ticks;
    traffic.neighbours.push_back(neighbour_of(packet, ticks > dead ? 0 : bytes[0]));
  }
  traffic.unchanged = std::move(now);
}

void tell(const Traffic& traffic, ziggurat::RangeAndBearing& device, Random& random) {
  const int flags = (traffic.working ? working : 0) + (traffic.asking ? asking : 0) +
                    (traffic.holding ? holding : 0) + (traffic.stopped ? stopped : 0) +
                    row * traffic.row;
  const std::array<std::uint8_t, packet_bytes> data = {
      static_cast<std::uint8_t>(flags), traffic.claim,
      static_cast<std::uint8_t>(random.uniform_int(0, 256))};
  device.set_data(data);
}

bool may_enter(Traffic& traffic, Random& random, const Judgement& is_in_the_way,
               const Judgement& is_rival) {
  if (!traffic.asking) {
    traffic.asking = true;
    traffic.asked = 0;
    traffic.claim = static_cast<std::uint8_t>(random.uniform_int(1, 256));
  }
  ++traffic.asked;
  for (const Neighbour& other : traffic.neighbours) {
    const bool has_priority = other.holding || (other.asking && other.claim >= traffic.claim);
    const bool hinders = (is_in_the_way(other) && (has_priority || !other.asking)) ||
                         (has_priority && is_rival(other));
    if (!hinders) continue;
    traffic.asked = 0;
    if (other.claim == traffic.claim) traffic.asking = false;  // a draw: another claim
    return false;
  }
  if (traffic.asked < 5) return false;
  traffic.asking = false;
  traffic.holding = true;
  return true;
}

void leave_structure(Traffic& traffic) {
  traffic.asking = traffic.holding = false;
  traffic.row = 0;
}

// Robots reach 14 cm around their centres, this one's front is 6 cm wide around the arm.
bool is_blocked(const Traffic& traffic, double direction, double reach) {
  const double front = direction > 0 ? 0.10 : -0.03;
  for (const Neighbour& other : traffic.neighbours) {
    if (other.forward * direction > 0 && is_within({other.forward, other.left}, {front, 0}, reach))
      return true;
  }
  return false;
}

const Neighbour* nearest(const Traffic& traffic) {
  const Neighbour* nearest = nullptr;
  for (const Neighbour& other : traffic.neighbours) {
    if (!nearest || other.range < nearest->range) nearest = &other;
  }
  return nearest;
}

Point place_of(const Neighbour& other, const Pose& pose) {
  const double c = std::cos(pose.yaw), s = std::sin(pose.yaw);
  return {pose.x + c * other.forward - s * other.left, pose.y + s * other.forward + c * other.left};
}

void add_obstacles(const Traffic& traffic, const Pose& pose, std::vector<Obstacle>& list) {
  for (const Neighbour& other : traffic.neighbours) {
    if (!other.working && other.range >= 0.7) continue;
    list.push_back({place_of(other, pose), other.working ? 0.36 : 0.3, 0.48});
  }
}

}  // namespace assembly
