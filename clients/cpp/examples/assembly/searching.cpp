// SPDX-License-Identifier: MIT
// The states in which a robot looks for the structure and for material, and parks.

#include <algorithm>
#include <cmath>

#include "assembler.h"

namespace assembly {

Next scan(Assembler& self, Faces /*faces*/) {
  constexpr double rate = 0.7;  // [rad/s]
  Job& job = self.job;
  if (job.seconds() <= construction::tick) job.turned = 0;
  spin(self, rate);
  job.turned = job.turned + rate * construction::tick;
  if (job.turned <= 2 * pi + 0.3) return {};
  wait(self);
  return job.after_scan ? *job.after_scan : decide(self);
}

// No lit block was ever seen: looks from somewhere else. Around the places of the dark blocks that
// it saw, at first near their middle, then farther out.
Next wander(Assembler& self, Faces /*faces*/) {
  if (middle_of(self.memory)) return decide(self);
  Job& job = self.job;
  if (job.seconds() <= construction::tick) {
    Point sum;
    for (const auto& block : self.memory.material) sum = {sum.x + block->x, sum.y + block->y};
    const auto count = static_cast<double>(self.memory.material.size());
    if (count > 0) sum = {sum.x / count, sum.y / count};
    const double direction = self.random.uniform(-pi, pi);
    const double radius = 0.1 + 0.15 * job.rounds;
    job.rounds = job.rounds < 6 ? job.rounds + 1 : 0;
    job.wander_to = ahead_of({sum, direction}, radius);
  }
  const Arrival arrival = travel_to(self, job.wander_to);
  if (arrival != Arrival::under_way || job.seconds() > 30) return State::scan;
  return {};
}

// Looks for material from places around the structure. When it finds neither material nor a side
// that waits for some, the structure is complete.
Next search(Assembler& self, Faces faces) {
  Job& job = self.job;
  if (!self.memory.material.empty() && choose_block(self, faces) == State::fetch) {
    return State::fetch;
  }
  if (job.points.empty()) {
    ++job.rounds;
    if (job.rounds > 4 || (job.rounds > 1 && open_sides(self.memory, self.plan, 900).empty())) {
      return State::park;
    }
    job.points = ring(self, search_ring, 5);
  }
  const Arrival arrival = travel_to(self, place_of(self, job.points.front()));
  if (arrival == Arrival::under_way && job.seconds() <= 40) return {};
  job.points.erase(job.points.begin());
  job.after_scan = State::search;
  return State::scan;
}

namespace {

/// Whether no dark block is remembered under or near the one that the robot carries.
bool is_free(const Assembler& self) {
  return std::ranges::none_of(self.memory.material,
                              [&](const auto& block) { return distance_to(self, *block) < 0.25; });
}

}  // namespace

Next park(Assembler& self, Faces /*faces*/) {
  Job& job = self.job;
  if (job.points.empty() || !job.points.front().is_for_parking) {
    job.points = ring(self, parking_ring, 12);
    job.points.front().is_for_parking = true;
  }
  const Point goal = place_of(self, job.points.front());
  if (is_taken(self, goal, 0.35)) {
    job.points.erase(job.points.begin());
    if (!job.points.empty()) job.points.front().is_for_parking = true;
    return {};
  }
  const Arrival arrival = travel_to(self, goal);
  if (arrival == Arrival::there && self.builder.loaded && is_free(self)) return State::put_down;
  if (arrival == Arrival::there || job.seconds() > 90) return State::done;
  return {};
}

// A block that is left over goes back to the floor.
Next put_down(Assembler& self, Faces /*faces*/) {
  if (self.builder.lift_to(0.0002, 0.02)) return State::let_left_over_go;
  return {};
}

Next let_left_over_go(Assembler& self, Faces /*faces*/) {
  self.builder.set_current(std::max(-1.0, -2 * self.job.seconds()));
  if (self.job.seconds() < 1.5) return {};
  self.builder.loaded = false;
  if (!self.builder.lift_to(clearance, 0.03)) return {};
  self.builder.drive(-0.05, 0);
  if (self.job.seconds() > 6) return State::done;
  return {};
}

Next done(Assembler& self, Faces /*faces*/) {
  self.builder.stop();
  return {};
}

}  // namespace assembly
