// The states in which a robot places the block that it carries, where the structure's colours say.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "assembler.h"

namespace assembly {
namespace {

/// From the robot's centre to the side at which it places by this row [m].
double distance_of(const Row& row) {
  return row.above ? construction::reach : construction::reach + pitch;
}

Point last_way_to(const Pose& side, const Row& row) {
  return ahead_of(side, distance_of(row) + last_way);
}

/// Of the carried block above the floor, when it is placed by this row [m].
double height_of(const Row& row) { return row.above ? row.height * construction::block : 0; }

/// Of the lift on the way there: the carried block passes over the column [m].
double height_to_carry(const Row& row) {
  return carrying + std::max(0, row.height - 1) * construction::block;
}

/// The side with the shortest free way of those that may get a block; none if none is known.
std::optional<Place> nearest_side(const Assembler& self) {
  std::vector<Point> material;
  for (const auto& block : self.memory.material) material.push_back(*block);
  double least = std::numeric_limits<double>::infinity();
  std::optional<Place> nearest;
  for (const OpenSide& side : open_sides(self.memory)) {
    const double cost = distance_to(self, last_way_to(side, *side.row)) + hindrance(side, material);
    if (cost >= least) continue;
    least = cost;
    nearest = Place{side, *side.row, side.column, side.side};
  }
  return nearest;
}

double direction_to_middle(const Assembler& self) { return direction_to(self, middle(self)); }

/// What the side shows does not count until it is seen again.
void forget_color(const Place& place) {
  if (!place.column) return;
  auto& look = place.column->sides[static_cast<std::size_t>(place.side)];
  if (look) look->row = nullptr;
}

Next give_up_side(Assembler& self) {
  leave_structure(self.traffic);
  forget_color(self.job.place);
  return State::choose_side;
}

void log_docked(Assembler& self, const construction::Face& face) {
  char text[100];
  std::snprintf(text, sizeof text, "docked %.20s %g mm %g", self.job.place.row.becomes.c_str(),
                1000 * face.offset(), face.heading * (180.0 / pi));
  self.robot.log(text);
}

}  // namespace

Next choose_side(Assembler& self, Faces /*faces*/) {
  self.job.after_scan.reset();
  if (!middle_of(self.memory)) return State::wander;
  self.job.tries = 0;
  self.job.points.clear();
  return nearest_side(self) ? State::claim : State::survey;
}

// Looks at the structure from all sides. When no side may get a block, it is complete.
Next survey(Assembler& self, Faces /*faces*/) {
  Job& job = self.job;
  if (!open_sides(self.memory).empty()) {
    job.rounds = 0;
    return State::choose_side;
  }
  if (job.points.empty()) {
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

// Waits outside until no other robot works at the structure.
Next claim(Assembler& self, Faces /*faces*/) {
  if (may_build(self.traffic, self.random)) {
    const std::optional<Place> place = nearest_side(self);  // by what it has seen since
    self.job.tries = 0;
    if (place) {
      self.job.place = *place;
      return State::enter;
    }
    leave_structure(self.traffic);
    return State::survey;
  }
  const Point centre = middle(self);
  const double radius = waiting_ring + extent_of(self.memory);
  if (distance_to(self, centre) < radius - 0.05) {
    const Pose& pose = self.odometry.pose;
    const double angle = std::atan2(pose.y - centre.y, pose.x - centre.x);
    travel_to(self, ahead_of({centre, angle}, radius));
  } else if (turn_to(self, direction_to_middle(self))) {
    wait(self);
  }
  return {};
}

Next enter(Assembler& self, Faces /*faces*/) {
  const Place& place = self.job.place;
  self.builder.lift_to(height_to_carry(place.row), 0.05);
  const Arrival arrival = travel_to(self, last_way_to(place, place.row));
  if (arrival == Arrival::there) return State::aim_at_side;
  if (arrival == Arrival::stuck || self.job.seconds() > 60) return give_up_side(self);
  return {};
}

// What the side shows now counts, not what is remembered.
Next aim_at_side(Assembler& self, Faces faces) {
  Place& place = self.job.place;
  const std::optional<SeenFace> seen = seen_at(faces, self.odometry.pose, place);
  if (seen) {
    static_cast<Pose&>(place) = seen->place;
    const Row* row = seen->face.color ? self.plan.row_shown(*seen->face.color) : nullptr;
    if (!row || row->index != place.row.index) return give_up_side(self);
  }
  if (turn_to(self, direction_to(self, place))) {
    if (seen) return State::attach;
    if (self.job.seconds() > 4) return give_up_side(self);
  }
  if (self.job.seconds() > 20) return give_up_side(self);
  return {};
}

Next attach(Assembler& self, Faces faces) {
  using construction::Docking;
  construction::Builder& builder = self.builder;
  Place& place = self.job.place;
  const double seconds = self.job.seconds();
  if (const auto seen = seen_at(faces, self.odometry.pose, place)) {
    static_cast<Pose&>(place) = seen->place;
  }
  if (is_blocked(self.traffic, 1) && seconds < 30) {
    builder.stop();
    return {};
  }
  const bool above = place.row.above;
  const bool is_lifted = builder.lift_to(above ? height_to_carry(place.row) : carrying, 0.05);
  if (above && !is_lifted) {
    builder.stop();
    return {};
  }
  const construction::Face face = face_of(self, place);
  const Docking outcome = builder.dock_at(face, 0.05, above, distance_of(place.row));
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

Next place(Assembler& self, Faces /*faces*/) {
  const Row& row = self.job.place.row;
  // The block remembers for the robot what it was at.
  self.builder.send(std::array<std::uint8_t, 3>{3, self.job.payload.value_or(0), row.index});
  const double height = height_of(row);
  if (self.builder.lift_to(std::max(0.0002, height - 0.0002), height > 0 ? 0.01 : 0.02)) {
    return State::tell;
  }
  return {};
}

// Tells the block its state. From now on it tells the other robots what may be attached.
Next tell(Assembler& self, Faces /*faces*/) {
  const std::uint8_t number = self.job.place.row.number;
  self.builder.send(std::array<std::uint8_t, 3>{1, number, self.job.payload.value_or(0)});
  if (self.job.seconds() >= 0.5) return State::release;
  return {};
}

Next release(Assembler& self, Faces /*faces*/) {
  self.builder.set_current(std::max(-1.0, -2 * self.job.seconds()));
  if (self.job.seconds() > 1.5) return State::rise;
  return {};
}

Next rise(Assembler& self, Faces /*faces*/) {
  self.builder.loaded = false;
  const double height = std::min(highest_lift, height_of(self.job.place.row) + 0.03);
  if (self.builder.lift_to(height, 0.03)) return State::back_off;
  return {};
}

Next back_off(Assembler& self, Faces /*faces*/) {
  if (is_blocked(self.traffic, -1) && self.job.seconds() < 20) {
    self.builder.stop();
    return {};
  }
  self.builder.drive(-0.05, 0);
  if (self.job.seconds() <= 3.5) return {};
  forget_color(self.job.place);
  leave_structure(self.traffic);
  return self.job.place.column ? State::choose_block : State::scan;
}

}  // namespace assembly
