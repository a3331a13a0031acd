// SPDX-License-Identifier: MIT
// The states in which a robot places the block that it carries, where the structure's colours say.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "assembler.h"
#include "corridor.h"

namespace assembly {
namespace {

constexpr int no_more_tries = 1'000'000;

/// Height of the carried block above the floor, when it is placed by this row [m].
double height_of(const Row& row) { return row.above ? row.height * construction::block : 0; }

/// Height of the lift on the way to the side; while it lines up, also if the colour changes.
double height_to_carry(const Row& row) {
  return carrying + (row.above ? row.height - 1 : 0) * construction::block;
}

/// The side with the shortest free way of those that may get a block; none if none is known, or
/// other robots are at work at each that is. What was seen long ago is less certain.
std::optional<Place> nearest_side(const Assembler& self) {
  std::vector<Point> material;
  for (const auto& block : self.memory.material) material.push_back(*block);
  double least = std::numeric_limits<double>::infinity();
  std::optional<Place> nearest;
  for (const OpenSide& side : open_sides(self.memory, self.plan)) {
    const double distance = distance_to(self, start_of(side, *side.row));
    if (is_corridor_taken(self, side, *side.row, distance)) continue;
    const double age = static_cast<double>(self.memory.now - side.seen);
    const double cost = distance + hindrance(side, material) + std::min(1.0, 1e-3 * age) +
                        (side.is_guessed ? 0.2 : 0);
    if (cost >= least) continue;
    least = cost;
    nearest = Place{side, *side.row, side.column, side.side};
  }
  return nearest;
}

double direction_to_middle(const Assembler& self) { return direction_to(self, middle(self)); }

/// Forgets the colour of the side until it is seen again.
void forget_color(const Assembler& self) {
  const Place& place = self.job.place;
  if (!place.column) return;
  place.column->sides[static_cast<std::size_t>(place.side)] = Look{nullptr, self.memory.now};
}

Next give_up_side(Assembler& self) {
  leave_structure(self.traffic);
  forget_color(self);
  return State::choose_side;
}

/// Colour of the side, whose pose is corrected by the camera. Nearer than 13 cm the LEDs are out of
/// the image.
/// @return nothing if it is not in sight; null if nothing may be attached there
std::optional<const Row*> look_at_side(Assembler& self, Faces faces) {
  Place& place = self.job.place;
  const std::optional<SeenFace> seen = seen_at(faces, self.odometry.pose, place);
  if (!seen) return std::nullopt;
  static_cast<Pose&>(place) = seen->place;
  if (seen->face.forward < 0.15) return &place.row;
  return seen->face.color ? self.plan.row_shown(*seen->face.color) : nullptr;
}

void tell_state(Assembler& self) {
  const Row& row = self.job.place.row;
  if (row.index == 0) return;
  self.builder.send(std::array<std::uint8_t, 3>{1, row.number, self.job.payload.value_or(0)});
}

void log_docked(Assembler& self, const construction::Face& face) {
  char text[100];
  std::snprintf(text, sizeof text, "docked %.20s %g mm %g", self.job.place.row.becomes.c_str(),
                1000 * face.offset(), face.heading * (180.0 / pi));
  self.robot.log(text);
}

}  // namespace

Next choose_side(Assembler& self, Faces /*faces*/) {
  Job& job = self.job;
  job.after_scan.reset();
  if (!middle_of(self.memory)) return State::wander;
  job.tries = 0;
  if (const std::optional<Place> place = nearest_side(self)) {
    job.place = *place;
    job.points.clear();
    return State::enter;
  }
  return open_sides(self.memory, self.plan).empty() ? State::survey : State::queue;
}

// Looks at the structure from all sides. When no side may get a block, it is complete.
Next survey(Assembler& self, Faces /*faces*/) {
  Job& job = self.job;
  if (nearest_side(self)) {
    job.rounds = 0;
    return State::choose_side;
  }
  if (job.points.empty()) {
    if (!open_sides(self.memory, self.plan).empty()) return State::queue;
    ++job.rounds;
    if (job.rounds > 3) return State::park;
    job.points = ring(self, survey_ring, 4);
  }
  if (job.points.front().is_reached) {
    if (!turn_to(self, direction_to_middle(self)) || job.seconds() <= 2) return {};
    job.points.erase(job.points.begin());
    return State::survey;
  }
  const Arrival arrival = travel_to(self, place_of(self, job.points.front()));
  if (arrival == Arrival::under_way && job.seconds() <= 40) return {};
  job.points.front().is_reached = true;
  return State::survey;
}

// Waits outside while others are at work at all sides that may get a block, then looks from
// elsewhere.
Next queue(Assembler& self, Faces /*faces*/) {
  Job& job = self.job;
  if (job.since % 5 == 0 && nearest_side(self)) return State::choose_side;
  if (job.seconds() > 6) {
    job.points = ring(self, survey_ring, 4);
    return State::survey;
  }
  const Point centre = middle(self);
  const double radius = waiting_ring + extent_of(self.memory);
  const double x = self.odometry.pose.x - centre.x, y = self.odometry.pose.y - centre.y;
  const double distance = std::sqrt(x * x + y * y);
  if (std::abs(distance - radius) > 0.1) {
    travel_to(self, {centre.x + radius / distance * x, centre.y + radius / distance * y});
  } else if (turn_to(self, std::atan2(-y, -x))) {
    wait(self);
  }
  return {};
}

// To where the straight way to the side begins.
Next enter(Assembler& self, Faces /*faces*/) {
  const Place& place = self.job.place;
  self.traffic.row = place.row.index;
  self.builder.lift_to(height_to_carry(place.row), 0.05);
  const Point start = start_of(place, place.row);
  const double distance = distance_to(self, start);
  if (!self.traffic.holding && distance < 0.7 &&
      is_corridor_taken(self, place, place.row, distance)) {
    leave_structure(self.traffic);
    return State::choose_side;
  }
  const Arrival arrival = travel_to(self, start);
  if (arrival == Arrival::there) {
    self.job.looked = self.memory.now;
    return State::claim;
  }
  if (arrival == Arrival::occupied && !self.traffic.holding) {
    leave_structure(self.traffic);
    return State::queue;
  }
  if (arrival == Arrival::stuck || self.job.seconds() > 60) return give_up_side(self);
  return {};
}

// Before the side, until the corridor to it is free. What the side shows now counts, not what is
// remembered.
Next claim(Assembler& self, Faces faces) {
  Job& job = self.job;
  Place& place = job.place;
  const std::optional<const Row*> row = look_at_side(self, faces);
  if (row && !*row) return give_up_side(self);
  if (row) {
    place.row = **row;
    job.looked = self.memory.now;
  }
  self.builder.lift_to(height_to_carry(place.row), 0.05);
  if (distance_to(self, start_of(place, place.row)) > 0.13) {
    self.traffic.asking = false;
    return State::enter;
  }
  const bool is_turned = turn_to(self, direction_to(self, place));
  if ((is_turned && self.memory.now - job.looked > 8) || job.seconds() > 60) {
    return give_up_side(self);
  }
  if (is_turned && row && (self.traffic.holding || may_enter(self, place, place.row))) {
    return State::attach;
  }
  return {};
}

Next attach(Assembler& self, Faces faces) {
  using construction::Docking;
  construction::Builder& builder = self.builder;
  Place& place = self.job.place;
  const double seconds = self.job.seconds();
  const std::optional<const Row*> row = look_at_side(self, faces);
  if (row && (!*row || (*row)->index != place.row.index)) {
    self.job.tries = no_more_tries;
    return State::retreat_from_side;
  }
  const bool above = place.row.above;
  const bool is_obstructed = is_blocked(self.traffic, 1, 0.19) && seconds < 30;
  if (is_obstructed || (!builder.lift_to(height_to_carry(place.row), 0.05) && above)) {
    builder.stop();
    return {};
  }
  const construction::Face face = face_of(self, place);
  const auto ranging = above ? construction::Ranging::proximity : construction::Ranging::camera;
  const Docking outcome = builder.dock_at(face, 0.05, ranging, distance_of(place.row),
                                          pivot_ahead(self.odometry, builder.loaded));
  const bool is_exact = std::abs(face.offset()) <= 0.001 && std::abs(face.heading) <= 0.015;
  if (outcome == Docking::docked && is_exact) {
    log_docked(self, face);
    return State::place;
  }
  if (outcome != Docking::under_way || seconds > 60) return State::retreat_from_side;
  return {};
}

Next retreat_from_side(Assembler& self, Faces /*faces*/) {
  const std::optional<bool> may_try = drive_back(self, 3.3, 5);
  if (!may_try) return {};
  return *may_try ? State::enter : give_up_side(self);
}

// The last 2 cm slowly: the magnets of what stands below pull.
Next place(Assembler& self, Faces /*faces*/) {
  const Row& row = self.job.place.row;
  // The block remembers for the robot what it was at.
  self.builder.send(std::array<std::uint8_t, 3>{3, self.job.payload.value_or(0), row.index});
  const double height = height_of(row);
  const double slow = height > 0 ? 0.01 : 0.02;
  const bool is_far = self.builder.lift_height() > height + 0.02;
  if (self.builder.lift_to(std::max(0.0002, height - 0.0002), is_far ? 0.05 : slow)) {
    return State::tell;
  }
  return {};
}

// Tells the block its state, often enough, as it does not hear while it sends. From now on it tells
// the other robots what may be attached.
Next tell(Assembler& self, Faces /*faces*/) {
  tell_state(self);
  if (self.job.seconds() >= 0.5) return State::release;
  return {};
}

Next release(Assembler& self, Faces /*faces*/) {
  tell_state(self);
  self.builder.set_current(std::max(-1.0, -2 * self.job.seconds()));
  if (self.job.seconds() > 1) return State::rise;
  return {};
}

Next rise(Assembler& self, Faces /*faces*/) {
  self.builder.loaded = false;
  const double height = height_of(self.job.place.row);
  self.builder.lift_to(std::min(highest_lift, height + 0.03), 0.05);
  if (self.builder.lift_height() > height + 0.012) return State::back_off;
  return {};
}

// When it is clear of the block, others may come.
Next back_off(Assembler& self, Faces /*faces*/) {
  const double seconds = self.job.seconds();
  if (is_blocked(self.traffic, -1) && seconds < 20) {
    self.builder.stop();
    return {};
  }
  self.builder.drive(-0.07, 0);
  if (self.builder.ahead() > 0.16 || seconds > 1.2) leave_structure(self.traffic);
  if (seconds <= 2.3) return {};
  const Place& place = self.job.place;
  if (!place.column) return State::scan;
  remember_attached(self.memory, self.plan, *place.column, place.side, place.row);
  return State::choose_block;
}

}  // namespace assembly
