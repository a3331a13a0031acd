// SPDX-License-Identifier: MIT
// The states in which a robot fetches a dark block.

#include <algorithm>
#include <charconv>
#include <limits>
#include <string_view>

#include "assembler.h"

namespace assembly {
namespace {

constexpr double gap = 0.003;  // over the block when the magnets are energised [m]

/// All that is remembered but the block itself.
std::vector<Point> obstacles_beside(const Memory& memory, const Block& block) {
  std::vector<Obstacle> list;
  add_obstacles(memory, list);
  std::vector<Point> others;
  for (const Obstacle& other : list) {
    const double square = squared(other.x - block.x) + squared(other.y - block.y);
    if (square > squared(0.01)) others.push_back(other);
  }
  return others;
}

Point run_up_to(const Pose& side) { return ahead_of(side, construction::reach + run_up); }

/// The number on a tag; none if it is no number.
std::optional<std::uint8_t> number_of(std::string_view payload) {
  std::uint8_t number = 0;
  const auto result = std::from_chars(payload.data(), payload.data() + payload.size(), number);
  if (result.ec != std::errc() || result.ptr != payload.data() + payload.size()) return {};
  return number;
}

Next give_up_block(Assembler& self, std::int64_t ticks) {
  self.job.target.block->avoid = self.memory.now + ticks;
  return State::choose_block;
}

Next forget_target(Assembler& self) {
  forget(self.memory, *self.job.target.block);
  return State::choose_block;
}

/// Whether the block below says that it has been placed.
bool is_placed(const construction::Builder& builder) {
  return std::ranges::any_of(builder.received(), [](const ziggurat::Bytes& message) {
    return !message.empty() && message[0] == 2;
  });
}

/// The block remembers for the robot which of its sides looks at it.
void tell_side(Assembler& self) {
  std::vector<std::uint8_t> message = {3};
  if (self.job.payload) message.push_back(*self.job.payload);
  self.builder.send(message);
}

}  // namespace

Next choose_block(Assembler& self, Faces /*faces*/) {
  Job& job = self.job;
  job.after_scan.reset();
  if (!middle_of(self.memory)) return State::wander;
  double least = std::numeric_limits<double>::infinity();
  job.target = {};
  for (const auto& block : self.memory.material) {
    if (is_taken(self, *block, 0.3) || self.memory.now <= block->avoid) continue;
    const std::vector<Point> obstacles = obstacles_beside(self.memory, *block);
    for (int side = 0; side < 4; ++side) {
      const double yaw = block->yaw + side * pi / 2;
      const Pose face = {ahead_of({*block, yaw}, construction::block / 2), yaw};
      const auto age = static_cast<double>(self.memory.now - block->seen);
      // Blocks in the way of building come first; old sightings count less, because another robot
      // may have taken the block.
      const double cost = distance_to(self, run_up_to(face)) + hindrance(face, obstacles) +
                          distance_from_middle(self, *block) + std::min(0.6, 5e-4 * age);
      if (cost >= least) continue;
      least = cost;
      job.target = {face, block};
    }
  }
  if (job.target.block) {
    job.tries = 0;
    return State::fetch;
  }
  if (job.state != State::search) job.points.clear();
  return State::search;
}

Next fetch(Assembler& self, Faces /*faces*/) {
  if (!is_free(self.memory, *self.job.target.block)) return State::choose_block;
  if (is_taken(self, self.job.target, 0.3)) return give_up_block(self, 200);
  const Arrival arrival = travel_to(self, run_up_to(self.job.target));
  if (arrival == Arrival::there) return State::aim;
  if (arrival != Arrival::under_way || self.job.seconds() > 90) return give_up_block(self, 200);
  self.builder.lift_to(clearance, 0.05);
  return {};
}

Next aim(Assembler& self, Faces faces) {
  Job& job = self.job;
  const std::optional<SeenFace> seen = seen_at(faces, self.odometry.pose, job.target);
  if (seen) {
    if (seen->face.color) return forget_target(self);
    static_cast<Pose&>(job.target) = seen->place;
  }
  if (turn_to(self, direction_to(self, job.target))) {
    if (seen) return State::approach;
    if (job.seconds() > 2.5) return forget_target(self);
  }
  if (job.seconds() > 15) return give_up_block(self, 200);
  return {};
}

Next approach(Assembler& self, Faces faces) {
  Job& job = self.job;
  if (const auto seen = seen_at(faces, self.odometry.pose, job.target)) {
    static_cast<Pose&>(job.target) = seen->place;
    job.payload = number_of(seen->face.payload);
  }
  if (is_blocked(self.traffic, 1)) {
    self.builder.stop();
    if (job.seconds() > 20) return give_up_block(self, 200);
    return {};
  }
  const auto outcome =
      self.builder.dock_at(face_of(self, job.target), 0.06, construction::Ranging::proximity,
                           construction::reach, pivot_ahead(self.odometry, self.builder.loaded));
  if (outcome == construction::Docking::docked) return State::lower;
  if (outcome == construction::Docking::askew || job.seconds() > 40) return State::retreat;
  return {};
}

// Back to where the run-up begins.
Next retreat(Assembler& self, Faces /*faces*/) {
  const std::optional<bool> may_try = drive_back(self, 2.5, 4);
  if (!may_try) return {};
  return *may_try ? State::fetch : give_up_block(self, 600);
}

Next lower(Assembler& self, Faces /*faces*/) {
  if (is_placed(self.builder)) {
    self.job.target.block->avoid = never;
    return State::let_go;
  }
  if (self.builder.lift_to(gap - 0.0005, 0.05)) return State::energise;
  return {};
}

Next energise(Assembler& self, Faces /*faces*/) {
  tell_side(self);
  self.builder.set_current(std::min(1.0, -1 + 2 * self.job.seconds()));
  if (self.job.seconds() <= 1.5) return {};
  return self.builder.holds() ? State::raise : State::let_go;
}

Next let_go(Assembler& self, Faces /*faces*/) {
  self.builder.set_current(-1);
  if (self.builder.lift_to(clearance, 0.03)) return State::retreat;
  return {};
}

Next raise(Assembler& self, Faces /*faces*/) {
  if (!self.builder.lift_to(carrying, 0.05)) {
    tell_side(self);
    return {};
  }
  self.builder.set_current(0);
  self.builder.loaded = self.builder.holds();
  if (!self.builder.loaded) return State::let_go;
  forget(self.memory, *self.job.target.block);
  self.job.points.clear();
  self.job.rounds = 0;
  return State::choose_side;
}

}  // namespace assembly
