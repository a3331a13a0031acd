#include "memory.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace assembly {
namespace {

using construction::Face;

// A dark block nearer to a column than this is left alone: it is just being placed, or was dropped,
// and to fetch it a robot would have to turn beside the structure [m].
constexpr double apart = 0.2;

/// The block of a face in the robot's frame: its centre and the face's outward normal.
Pose block_of(const Face& face, const Pose& pose) {
  const double heading = pose.yaw + face.heading;
  const double c = std::cos(pose.yaw), s = std::sin(pose.yaw);
  return {
      {pose.x + c * face.forward - s * face.left + 0.5 * construction::block * std::cos(heading),
       pose.y + s * face.forward + c * face.left + 0.5 * construction::block * std::sin(heading)},
      wrapped(heading + pi)};
}

Point point_of(const Pose& anchor, int i, int j) {
  const double c = std::cos(anchor.yaw) * pitch, s = std::sin(anchor.yaw) * pitch;
  return {anchor.x + i * c - j * s, anchor.y + i * s + j * c};
}

std::string key_of(int i, int j) { return std::to_string(i) + "," + std::to_string(j); }

/// The lattice column nearest to a block.
struct Nearest {
  int i = 0, j = 0;
  int side = 0;  // that the block's yaw belongs to
  Pose off;      // of the block from there
};

Nearest column_of(const Pose& block, const Pose& anchor) {
  const double dx = block.x - anchor.x, dy = block.y - anchor.y;
  const double c = std::cos(anchor.yaw) / pitch, s = std::sin(anchor.yaw) / pitch;
  const int i = static_cast<int>(std::floor(c * dx + s * dy + 0.5));
  const int j = static_cast<int>(std::floor(-s * dx + c * dy + 0.5));
  const double quarters = (block.yaw - anchor.yaw) / (pi / 2);
  const int side = static_cast<int>(std::floor(quarters + 0.5));
  const Point at = point_of(anchor, i, j);
  return {i, j, (side % 4 + 4) % 4, {{block.x - at.x, block.y - at.y}, (quarters - side) * pi / 2}};
}

bool fits(const Pose& off) {
  return std::abs(off.yaw) < 0.35 && off.x * off.x + off.y * off.y < squared(0.035);
}

/// Shifts and turns the robot's pose so that a block that is off would be where it should.
void correct(Pose& pose, const Pose& off, const Pose& block) {
  const double c = std::cos(-off.yaw), s = std::sin(-off.yaw);
  const double dx = pose.x - block.x, dy = pose.y - block.y;
  pose.x = block.x - off.x + c * dx - s * dy;
  pose.y = block.y - off.y + s * dx + c * dy;
  pose.yaw = pose.yaw - off.yaw;
}

/// Corrects the odometry by the nearest lit face; starts anew if that doesn't fit for a second.
/// @return true if it does
bool find_oneself(Memory& memory, Odometry& odometry, bool loaded, const Face& face) {
  const Pose block = block_of(face, odometry.pose);
  if (!memory.anchor) {
    memory.anchor = block;
    return false;
  }
  const Nearest column = column_of(block, *memory.anchor);
  if (!fits(column.off)) {
    if (++memory.astray <= 10) return false;
    memory.anchor = block;
    memory.columns.clear();
    memory.astray = 0;
    return true;
  }
  memory.astray = 0;
  std::string key = key_of(column.i, column.j) + "," + std::to_string(column.side);
  if (memory.last_lit == key && memory.last_lit_seen == memory.now - 1) {
    learn(odometry, loaded, column.off);
  }
  memory.last_lit = std::move(key);
  memory.last_lit_seen = memory.now;
  correct(odometry.pose, column.off, block);
  return false;
}

void remember_side(Memory& memory, const Pose& robot, const Face& face, const Plan& plan) {
  const auto [i, j, side, off] = column_of(block_of(face, robot), *memory.anchor);
  if (!fits(off)) return;
  std::shared_ptr<Column>& column = memory.columns[key_of(i, j)];
  if (!column) {
    column = std::make_shared<Column>();
    static_cast<Point&>(*column) = point_of(*memory.anchor, i, j);
    column->i = i;
    column->j = j;
  }
  std::erase_if(memory.material,
                [&](const auto& each) { return is_within(*each, *column, apart); });
  column->seen = memory.now;
  column->sides[static_cast<std::size_t>(side)] = {plan.row_shown(*face.color), memory.now};
}

void remember_material(Memory& memory, Odometry& odometry, bool loaded, const Face& face) {
  auto block = std::make_shared<Block>();
  static_cast<Pose&>(*block) = block_of(face, odometry.pose);
  for (const auto& [key, column] : memory.columns) {
    if (is_within(*block, *column, apart)) return;
  }
  block->seen = memory.now;
  for (std::shared_ptr<Block>& known : memory.material) {
    if (!is_within(*block, *known, 0.04)) continue;
    if (known->seen == memory.now - 1) {
      learn(odometry, loaded, {block->x - known->x, block->y - known->y});
    }
    block->avoid = known->avoid;
    known = std::move(block);
    return;
  }
  memory.material.push_back(std::move(block));
}

/// Whether what a side showed is out of date: a column was seen before it since, or another side of
/// its column showed another row.
bool is_old(const Memory& memory, const Column& column, int side, const Look& look) {
  constexpr int directions[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  const auto beside =
      memory.columns.find(key_of(column.i + directions[side][0], column.j + directions[side][1]));
  if (!look.row->above && beside != memory.columns.end() && beside->second->seen > look.seen) {
    return true;
  }
  return std::ranges::any_of(column.sides, [&](const std::optional<Look>& other) {
    return other && other->row && other->row != look.row && other->seen > look.seen + 50;
  });
}

}  // namespace

// Nearer than 13 cm the LEDs are out of the image.
bool update(Memory& memory, Odometry& odometry, bool loaded, Faces faces, const Plan& plan) {
  ++memory.now;
  bool found_oneself = false, is_lost = false;
  for (const Face& face : faces) {
    if (!is_at_floor_level(face) || !face.color || face.forward <= 0.13 || face.forward >= 0.95) {
      continue;
    }
    if (!found_oneself) is_lost = find_oneself(memory, odometry, loaded, face);
    found_oneself = true;
    if (std::abs(face.heading) < 1.1) remember_side(memory, odometry.pose, face, plan);
  }
  for (const Face& face : faces) {
    if (is_at_floor_level(face) && !face.color && face.forward > 0.14 && face.forward < 0.8) {
      remember_material(memory, odometry, loaded, face);
    }
  }
  return is_lost;
}

void forget(Memory& memory, const Point& block) {
  const auto found = std::ranges::find_if(
      memory.material, [&](const auto& known) { return is_within(block, *known, 0.05); });
  if (found != memory.material.end()) memory.material.erase(found);
}

std::optional<Point> middle_of(const Memory& memory) {
  if (memory.columns.empty()) return memory.anchor;
  Point sum;
  for (const auto& [key, column] : memory.columns) {
    sum.x = sum.x + column->x;
    sum.y = sum.y + column->y;
  }
  const auto count = static_cast<double>(memory.columns.size());
  return Point{sum.x / count, sum.y / count};
}

double extent_of(const Memory& memory) {
  double most = 0;
  for (const auto& [key, column] : memory.columns) {
    most = std::max(most, distance_between(*column, *middle_of(memory)));
  }
  return most;
}

std::vector<OpenSide> open_sides(const Memory& memory, std::int64_t ticks) {
  std::vector<OpenSide> open;
  for (const auto& [key, column] : memory.columns) {
    for (int side = 0; side < 4; ++side) {
      const std::optional<Look>& look = column->sides[static_cast<std::size_t>(side)];
      if (!look || !look->row || memory.now - look->seen >= ticks) continue;
      if (is_old(memory, *column, side, *look)) continue;
      const double yaw = memory.anchor->yaw + side * pi / 2;
      open.push_back({{{column->x + 0.5 * construction::block * std::cos(yaw),
                        column->y + 0.5 * construction::block * std::sin(yaw)},
                       yaw},
                      column,
                      side,
                      look->row});
    }
  }
  return open;
}

void add_obstacles(const Memory& memory, std::vector<Obstacle>& list) {
  for (const auto& [key, column] : memory.columns) {
    list.push_back({{column->x, column->y}, 0.185, 0.26});
  }
  for (const auto& each : memory.material) list.push_back({{each->x, each->y}, 0.13, 0.18});
}

std::optional<SeenFace> seen_at(Faces faces, const Pose& robot, const Pose& place) {
  std::optional<SeenFace> best;
  double nearest = 0.04;
  for (const Face& face : faces) {
    if (!is_at_floor_level(face)) continue;
    const Pose block = block_of(face, robot);
    const Pose side = {ahead_of(block, 0.5 * construction::block), block.yaw};
    const double distance = distance_between(side, place);
    if (distance >= nearest || std::abs(wrapped(block.yaw - place.yaw)) >= 0.5) continue;
    best = SeenFace{face, side};
    nearest = distance;
  }
  return best;
}

}  // namespace assembly
