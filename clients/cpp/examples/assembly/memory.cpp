// SPDX-License-Identifier: MIT
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

constexpr int directions[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};

/// The column beside a side; null if none is known.
const Column* column_beside(const Memory& memory, const Column& column, int side) {
  const auto found =
      memory.columns.find(key_of(column.i + directions[side][0], column.j + directions[side][1]));
  return found == memory.columns.end() ? nullptr : found->second.get();
}

Column& column_at(Memory& memory, int i, int j) {
  std::shared_ptr<Column>& column = memory.columns[key_of(i, j)];
  if (column) return *column;
  column = std::make_shared<Column>();
  static_cast<Point&>(*column) = point_of(*memory.anchor, i, j);
  column->i = i;
  column->j = j;
  column->seen = memory.now;
  return *column;
}

std::optional<Look>& look_of(Column& column, int side) {
  return column.sides[static_cast<std::size_t>(side)];
}

/// Sets the colours that a column shows by the rule table, if its lowest block has this state and
/// its front is that side.
void expect(const Memory& memory, const Plan& plan, Column& column, const std::string& state,
            int height, int front) {
  for (int side = 0; side < 4; ++side) {
    const bool is_occupied = column_beside(memory, column, side) != nullptr;
    const Row* row = plan.row_for(state, height, (side - front + 4) % 4, is_occupied);
    look_of(column, side) = Look{row, memory.now, row != nullptr};
  }
}

void remember_side(Memory& memory, const Pose& robot, const Face& face, const Plan& plan) {
  const auto [i, j, side, off] = column_of(block_of(face, robot), *memory.anchor);
  if (!fits(off)) return;
  Column& column = column_at(memory, i, j);
  std::erase_if(memory.material, [&](const auto& each) { return is_within(*each, column, apart); });
  column.seen = memory.now;
  const Row* row = plan.row_shown(*face.color);
  std::optional<Look>& look = look_of(column, side);
  if (const Row* before = look ? look->row : nullptr;
      !row && before && before->above && !before->is_everywhere) {
    expect(memory, plan, column, before->state, before->height + 1,
           side);  // somebody attached a block
  }
  look = Look{row, memory.now};
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

/// A thing that hides what is behind it, in the robot's frame [m].
struct Screen {
  double forward = 0, left = 0;
  double width = 0;  // to each side
};

Screen seen_from(const Pose& pose, const Point& point, double width) {
  const double c = std::cos(pose.yaw), s = std::sin(pose.yaw);
  const double dx = point.x - pose.x, dy = point.y - pose.y;
  return {c * dx + s * dy, -s * dx + c * dy, width};
}

bool is_hidden(const Screen& block, const std::vector<Screen>& screens) {
  return std::ranges::any_of(screens, [&](const Screen& thing) {
    return thing.forward > 0 && thing.forward < block.forward - 0.03 &&
           std::abs(thing.left - block.left * thing.forward / block.forward) < thing.width;
  });
}

/// Ignores dark blocks at which another robot is at work. Forgets blocks that were missing in sight
/// for a second: another robot took them.
void forget_taken(Memory& memory, const Pose& pose, const Traffic& traffic) {
  constexpr double block_width = 0.05, robot_width = 0.17;
  for (const Neighbour& other : traffic.neighbours) {
    if (!other.working || other.holding) continue;
    for (const auto& block : memory.material) {
      const Screen at = seen_from(pose, *block, block_width);
      if (!is_within({at.forward, at.left}, {other.forward, other.left}, 0.15)) continue;
      block->avoid = std::max(block->avoid, memory.now + 300);
    }
  }
  std::vector<Screen> screens;
  for (const auto& [key, column] : memory.columns) {
    screens.push_back(seen_from(pose, *column, block_width));
  }
  for (const auto& block : memory.material) {
    screens.push_back(seen_from(pose, *block, block_width));
  }
  for (const Neighbour& other : traffic.neighbours) {
    screens.push_back({other.forward, other.left, robot_width});
  }
  std::erase_if(memory.material, [&](const std::shared_ptr<Block>& block) {
    const Screen at = seen_from(pose, *block, block_width);
    const bool is_in_sight = at.forward > 0.25 && at.forward < 0.65 &&
                             std::abs(at.left) < 0.3 * at.forward - 0.05 && !is_hidden(at, screens);
    if (is_in_sight && block->seen < memory.now) ++block->missed;
    return block->missed > 10;
  });
}

/// Last colour that a column showed on all of its sides. Its neighbours tell it, too: they were
/// attached by the colour that it showed.
std::optional<Look> shown_all_around(const Memory& memory, const Plan& plan, const Column& column) {
  std::optional<Look> latest;
  for (const std::optional<Look>& look : column.sides) {
    if (!look || !look->row || !look->row->is_everywhere) continue;
    if (!latest || look->seen > latest->seen) latest = look;
  }
  if (!latest) return latest;
  for (int side = 0; side < 4; ++side) {
    const Column* beside = column_beside(memory, column, side);
    if (!beside) continue;
    for (const std::optional<Look>& look : beside->sides) {
      if (!look || !look->row) continue;
      const Row* origin = plan.origin_of(*look->row, latest->row->state);
      if (origin && origin->is_everywhere && look->seen > latest->seen) {
        latest = Look{origin, look->seen};
      }
    }
  }
  return latest;
}

/// Whether what a side showed is out of date: a column was seen before it since, or another side of
/// its column showed another row.
/// @param latest  what the column showed last on all sides
bool is_old(const Memory& memory, const Column& column, int side, const Look& look,
            const std::optional<Look>& latest) {
  const Column* beside = column_beside(memory, column, side);
  if (!look.row->above && beside && beside->seen > look.seen) return true;
  if (latest && latest->row != look.row && latest->seen > look.seen) return true;
  return std::ranges::any_of(column.sides, [&](const std::optional<Look>& other) {
    return other && other->row && other->row != look.row && other->seen > look.seen + 50;
  });
}

/// Colour of a side, as far as it is known; nothing if nothing may be attached there.
/// @param latest  of shown_all_around()
std::optional<Look> look_at(const Memory& memory, const Column& column, int side,
                            const std::optional<Look>& latest) {
  const std::optional<Look>& look = column.sides[static_cast<std::size_t>(side)];
  if (look && look->row && !is_old(memory, column, side, *look, latest)) return look;
  const bool is_open = !look || (look->row && latest && look->row != latest->row);
  if (!latest || column_beside(memory, column, side) || !is_open) return std::nullopt;
  return Look{latest->row, latest->seen, true};
}

}  // namespace

// Nearer than 13 cm the LEDs are out of the image.
bool update(Memory& memory, Odometry& odometry, bool loaded, Faces faces, const Plan& plan,
            const Traffic& traffic) {
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
  forget_taken(memory, odometry.pose, traffic);
  return is_lost;
}

void remember_attached(Memory& memory, const Plan& plan, Column& column, int side, const Row& row) {
  if (row.above) {
    expect(memory, plan, column, row.state, row.height + 1, side);
    return;
  }
  Column& attached =
      column_at(memory, column.i + directions[side][0], column.j + directions[side][1]);
  attached.seen = memory.now;
  look_of(column, side) = Look{nullptr, memory.now};
  expect(memory, plan, attached, row.becomes, 1, side);
}

namespace {

auto find_near(const std::vector<std::shared_ptr<Block>>& material, const Point& place) {
  return std::ranges::find_if(material,
                              [&](const auto& known) { return is_within(place, *known, 0.05); });
}

}  // namespace

bool is_free(const Memory& memory, const Point& block) {
  const auto found = find_near(memory.material, block);
  return found != memory.material.end() && memory.now > (*found)->avoid;
}

void forget(Memory& memory, const Point& block) {
  const auto found = find_near(memory.material, block);
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
  if (memory.columns.empty()) return 0;
  double most = 0;
  const Point middle = *middle_of(memory);
  for (const auto& [key, column] : memory.columns) {
    most = std::max(most, distance_between(*column, middle));
  }
  return most;
}

std::vector<OpenSide> open_sides(const Memory& memory, const Plan& plan, std::int64_t ticks) {
  std::vector<OpenSide> open;
  for (const auto& [key, column] : memory.columns) {
    const std::optional<Look> latest = shown_all_around(memory, plan, *column);
    for (int side = 0; side < 4; ++side) {
      const std::optional<Look> look = look_at(memory, *column, side, latest);
      if (!look || memory.now - look->seen >= ticks) continue;
      const double yaw = memory.anchor->yaw + side * pi / 2;
      open.push_back({{{column->x + 0.5 * construction::block * std::cos(yaw),
                        column->y + 0.5 * construction::block * std::sin(yaw)},
                       yaw},
                      column,
                      side,
                      look->row,
                      look->seen,
                      look->is_guessed});
    }
  }
  return open;
}

void add_obstacles(const Memory& memory, std::vector<Obstacle>& list) {
  for (const auto& [key, column] : memory.columns) {
    list.push_back({{column->x, column->y}, 0.185, 0.26});
  }
  for (const auto& each : memory.material) list.push_back({{each->x, each->y}, 0.14, 0.2});
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
