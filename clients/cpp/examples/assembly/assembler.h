// SPDX-License-Identifier: MIT
#pragma once
// A robot that builds, with any number of others, what a rule table says: all that it knows. Its
// states are those of scenes/construction/assembler.lua.

#include <ziggurat/ziggurat.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "../construction/builder.h"
#include "memory.h"
#include "odometry.h"
#include "random.h"
#include "rules.h"
#include "traffic.h"
#include "travel.h"

namespace assembly {

inline constexpr double clearance = 0.03;     ///< lift, without a block [m]
inline constexpr double carrying = 0.075;     ///< lift, with a block, out of the camera's sight [m]
inline constexpr double run_up = 0.13;        ///< straight way to a dark block [m]
inline constexpr double highest_lift = 0.14;  ///< [m]

// Distances from the structure's outermost column [m].
inline constexpr double waiting_ring = 0.55;  ///< where robots wait
inline constexpr double survey_ring = 0.42;   ///< from where they look at it
inline constexpr double search_ring = 0.55;   ///< from where they look for material
inline constexpr double parking_ring = 0.85;  ///< where they stay when it is complete

enum class State {
  start,
  sense,
  withdraw,
  scan,
  wander,
  search,
  park,
  put_down,
  let_left_over_go,
  done,
  choose_block,
  fetch,
  aim,
  approach,
  retreat,
  lower,
  energise,
  let_go,
  raise,
  choose_side,
  survey,
  queue,
  enter,
  claim,
  attach,
  retreat_from_side,
  place,
  tell,
  release,
  rise,
  back_off
};
using Next = std::optional<State>;  ///< none: the state goes on

/// The material block that it fetches, by one of its sides.
struct Target : Pose {
  std::shared_ptr<Block> block;
};

/// The side at which it attaches. One that was started again has neither pose nor column.
struct Place : Pose {
  Row row;
  std::shared_ptr<Column> column;
  int side = 0;
};

/// A place around the structure to look from.
struct Viewpoint {
  double angle = 0, radius = 0;  ///< from the structure's middle [rad, m]
  bool is_reached = false, is_for_parking = false;
};

/// Job of the robot: its state, and the place that it works at.
struct Job {
  State state = State::start;
  int since = 0;  ///< age of the state [ticks]
  Target target;
  Place place;
  std::int64_t looked = 0;              ///< when it saw that side last [ticks]
  std::optional<std::uint8_t> payload;  ///< number on that side of the carried block that it sees
  Next after_scan;
  std::vector<Viewpoint> points;  ///< still to look from
  int rounds = 0;                 ///< how often it looked from everywhere in vain
  int tries = 0;                  ///< how often it approached one side
  double turned = 0;              ///< while it looks around [rad]
  Point wander_to;
  double withdraw_to = 0;   ///< lift [m]
  std::optional<int> back;  ///< ticks to drive back yet

  double seconds() const { return since * construction::tick; }
};

struct Assembler {
  ziggurat::Robot& robot;
  Plan plan;
  Random random;
  std::uint64_t first_tick = 0;  ///< > 0 for one that was started again in the middle of its work
  construction::Builder builder;
  Odometry odometry{};
  Memory memory{};
  Traffic traffic{};
  Travel travel{};
  Job job{};
};

/// State that a robot begins with, free or with a block.
State decide(const Assembler& self);
double distance_to(const Assembler& self, const Point& place);
/// @pre  a column is known, as for all of the following
Point middle(const Assembler& self);
double distance_from_middle(const Assembler& self, const Point& place);
/// The direction from the robot to a place in the frame of the map [rad].
double direction_to(const Assembler& self, const Point& place);
/// A side, as a face in the robot's frame.
construction::Face face_of(const Assembler& self, const Pose& side);
/// Whether another robot is within reach of a place and nearer to it than this one.
bool is_taken(const Assembler& self, const Point& place, double reach);
/// Detour that is worth the obstacles on the straight way to a side [m].
double hindrance(const Pose& side, const std::vector<Point>& obstacles);
/// Points around the structure, the nearest first and then in one direction.
std::vector<Viewpoint> ring(Assembler& self, double radius, int count);
Point place_of(const Assembler& self, const Viewpoint& point);
/// Drives back for some seconds. Then: whether it may try again, which it may so often.
std::optional<bool> drive_back(Assembler& self, double seconds, int most);

// Each of these is called at every tick in its state.
Next start(Assembler& self, Faces faces);
Next sense(Assembler& self, Faces faces);
Next withdraw(Assembler& self, Faces faces);
Next scan(Assembler& self, Faces faces);
Next wander(Assembler& self, Faces faces);
Next search(Assembler& self, Faces faces);
Next park(Assembler& self, Faces faces);
Next put_down(Assembler& self, Faces faces);
Next let_left_over_go(Assembler& self, Faces faces);
Next done(Assembler& self, Faces faces);
Next choose_block(Assembler& self, Faces faces);
Next fetch(Assembler& self, Faces faces);
Next aim(Assembler& self, Faces faces);
Next approach(Assembler& self, Faces faces);
Next retreat(Assembler& self, Faces faces);
Next lower(Assembler& self, Faces faces);
Next energise(Assembler& self, Faces faces);
Next let_go(Assembler& self, Faces faces);
Next raise(Assembler& self, Faces faces);
Next choose_side(Assembler& self, Faces faces);
Next survey(Assembler& self, Faces faces);
Next queue(Assembler& self, Faces faces);
Next enter(Assembler& self, Faces faces);
Next claim(Assembler& self, Faces faces);
Next attach(Assembler& self, Faces faces);
Next retreat_from_side(Assembler& self, Faces faces);
Next place(Assembler& self, Faces faces);
Next tell(Assembler& self, Faces faces);
Next release(Assembler& self, Faces faces);
Next rise(Assembler& self, Faces faces);
Next back_off(Assembler& self, Faces faces);

}  // namespace assembly
