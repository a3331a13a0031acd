// SPDX-License-Identifier: MIT
#pragma once
// Drives the robot from place to place, around what it remembers and around other robots.

#include <cstdint>
#include <optional>
#include <vector>

#include "geometry.h"
#include "path.h"

namespace assembly {

struct Assembler;

/// An unknown thing that the robot nearly drove into.
struct Bump {
  Obstacle obstacle;
  std::int64_t seen = 0;  ///< [ticks]
};

struct Travel {
  std::optional<Point> goal;
  std::optional<std::vector<Point>> points;  ///< the way
  std::int64_t planned = 0;                  ///< when it was found [ticks]
  double speed = 0;                          ///< [m/s]
  int blocked = 0, patience = 20;            ///< [ticks]
  int evading_ticks = 0;                     ///< for which it drives out of somebody's way
  double evading_speed = 0;                  ///< [m/s]
  std::vector<Bump> bumps;
  std::optional<double> least_distance;  ///< to the goal so far [m]
  std::int64_t least_at = 0;             ///< [ticks]
  int waited = 0;                        ///< for which another robot has stood at the goal [ticks]
  std::int64_t made_room_at = -100;      ///< for a turn [ticks]
};

enum class Arrival { under_way, there, stuck, occupied };

/// Drives the point about which the robot turns to a place; call it in every step. `stuck` after 25
/// s without coming nearer, `occupied` when another robot has stood there for 2 s.
Arrival travel_to(Assembler& self, const Point& goal);
/// Turns on the spot to a direction; true when it has arrived.
bool turn_to(Assembler& self, double yaw);
/// Stands, and keeps its distance.
void wait(Assembler& self);
/// Turns on the spot [rad/s], and keeps its distance.
void spin(Assembler& self, double rate);
/// The next travel is another one.
void forget(Travel& travel);

}  // namespace assembly
