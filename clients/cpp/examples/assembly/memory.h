// SPDX-License-Identifier: MIT
#pragma once
// Memory of a robot, in a frame of its own: the structure's columns, the colours of their sides,
// and material. Columns stand on a square lattice; so every lit side that the camera sees corrects
// the odometry.

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "../construction/builder.h"
#include "geometry.h"
#include "odometry.h"
#include "path.h"
#include "rules.h"
#include "traffic.h"

namespace assembly {

using Faces = std::span<const construction::Face>;

inline constexpr double pitch = 0.078;  ///< distance of columns [m]
inline constexpr std::int64_t never = std::numeric_limits<std::int64_t>::max();  ///< [ticks]

/// A dark block; its yaw is that of a side's outward normal.
struct Block : Pose {
  std::int64_t seen = 0;   ///< [ticks]
  std::int64_t avoid = 0;  ///< until then it is left alone [ticks]
  int missed = 0;          ///< ticks for which it was not where it should be in sight
};

/// Colour that a side showed, and its time.
struct Look {
  const Row* row = nullptr;  ///< null: nothing that the table has
  std::int64_t seen = 0;     ///< [ticks]
  bool is_guessed = false;   ///< it must show that, but was not seen since
};

struct Column : Point {
  int i = 0, j = 0;       ///< on the lattice
  std::int64_t seen = 0;  ///< [ticks]
  std::array<std::optional<Look>, 4> sides;
};

/// Memory of blocks and columns. A holder of one keeps it when the memory has replaced it.
struct Memory {
  std::optional<Pose> anchor;  ///< the first column that was seen
  std::map<std::string, std::shared_ptr<Column>>
      columns;  ///< by "i,j", in the order of these texts
  std::vector<std::shared_ptr<Block>> material;
  std::int64_t now = 0;  ///< [ticks]
  // The side that corrected the odometry last, and when.
  std::string last_lit;
  std::int64_t last_lit_seen = 0;
  int astray = 0;  ///< ticks in a row in which a lit side was seen where no column can be
};

/// A side where something may be attached.
struct OpenSide : Pose {
  std::shared_ptr<Column> column;
  int side = 0;
  const Row* row = nullptr;
  std::int64_t seen = 0;    ///< [ticks]
  bool is_guessed = false;  ///< as in Look
};

/// A face that the camera sees now, and where it is in the frame of the map.
struct SeenFace {
  construction::Face face;
  Pose place;
};

/// Takes in what the camera sees, corrects the odometry, and forgets dark blocks that are not where
/// they should be: somebody took them.
/// @return true if it is lost and begins a new map
bool update(Memory& memory, Odometry& odometry, bool loaded, Faces faces, const Plan& plan,
            const Traffic& traffic);

/// The robot has attached a block by this row, above the column or before that side.
void remember_attached(Memory& memory, const Plan& plan, Column& column, int side, const Row& row);

/// Whether it still remembers a dark block there that is not to be left alone.
bool is_free(const Memory& memory, const Point& block);
void forget(Memory& memory, const Point& block);

/// The middle of all known columns; nothing if none is known.
std::optional<Point> middle_of(const Memory& memory);
/// The distance of the farthest column from the middle [m].
double extent_of(const Memory& memory);

/// All sides where something may be attached, seen in the last so many ticks.
std::vector<OpenSide> open_sides(const Memory& memory, const Plan& plan,
                                 std::int64_t ticks = never);

void add_obstacles(const Memory& memory, std::vector<Obstacle>& list);

/// The seen face nearest to the place of a block's side, within 4 cm.
std::optional<SeenFace> seen_at(Faces faces, const Pose& robot, const Pose& place);

}  // namespace assembly
