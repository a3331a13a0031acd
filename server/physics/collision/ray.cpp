// SPDX-License-Identifier: MIT
#include "physics/collision/ray.h"

#include <BulletCollision/BroadphaseCollision/btDbvt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>
#include <vector>

#include "physics/bodies/convert.h"
#include "physics/collision/sphere_grid.h"
#include "physics/stepping/team.h"

namespace ziggurat::physics {
namespace {

using math::Vector3;

constexpr double skin = 1e-4;  // [m]
// Margins of bounding volumes: with at least the first they are made, and made anew once less than
// the second is left [m]. So vibration at rest leaves the tree alone. What moves gets a margin for
// some ticks, up to a share of its size.
constexpr double volume_margin = 1e-3;
constexpr double rounding_margin = 1e-4;
constexpr double ticks_ahead = 8;
constexpr double margin_share = 0.25;
/// Largest number of solids that share a volume.
constexpr std::size_t most_in_group = 8;

/// Shares of the segment between which it is inside of something.
struct Stay {
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();
  void cut(double begin, double end) {
    from = std::max(from, begin);
    to = std::min(to, end);
  }
  void never() { cut(1, 0); }
};

/// Keeps where start + t * way lies between low and high.
void cut_slab(Stay& stay, double start, double way, double low, double high) {
  if (way == 0) {
    if (start < low || start > high) stay.never();
    return;
  }
  const double first = (low - start) / way, second = (high - start) / way;
  stay.cut(std::min(first, second), std::max(first, second));
}

/// Keeps where |start + t * way| <= radius.
template <class Vector>
void cut_round(Stay& stay, const Vector& start, const Vector& way, double radius) {
  const double a = way.squaredNorm();
  if (a == 0) {
    if (start.squaredNorm() > radius * radius) stay.never();
    return;
  }
  // About the point closest to the centre, where nothing cancels.
  const double closest = -start.dot(way) / a;
  const double room = radius * radius - (start + closest * way).squaredNorm();
  if (room < 0) return stay.never();
  const double half = std::sqrt(room / a);
  stay.cut(closest - half, closest + half);
}

Stay stay_in(const scene::Box& box, const Vector3& start, const Vector3& way) {
  Stay stay;
  cut_slab(stay, start.x(), way.x(), -box.size.x() / 2, box.size.x() / 2);
  cut_slab(stay, start.y(), way.y(), -box.size.y() / 2, box.size.y() / 2);
  cut_slab(stay, start.z(), way.z(), 0, box.size.z());
  return stay;
}

Stay stay_in(const scene::Cylinder& cylinder, const Vector3& start, const Vector3& way) {
  Stay stay;
  cut_slab(stay, start.z(), way.z(), 0, cylinder.height);
  cut_round(stay, math::Vector2(start.head<2>()), math::Vector2(way.head<2>()), cylinder.radius);
  return stay;
}

Stay stay_in(const scene::Sphere& sphere, const Vector3& start, const Vector3& way) {
  Stay stay;
  cut_round(stay, Vector3(start - Vector3(0, 0, sphere.radius)), way, sphere.radius);
  return stay;
}

/// In the cylinder or in one of the balls: of a convex shape that is one stay.
Stay stay_in(const scene::Capsule& capsule, const Vector3& start, const Vector3& way) {
  const double low = capsule.radius, high = capsule.height - capsule.radius;
  Stay side;
  cut_slab(side, start.z(), way.z(), low, high);
  cut_round(side, math::Vector2(start.head<2>()), math::Vector2(way.head<2>()), capsule.radius);
  Stay stay{1, 0};
  const auto join = [&](const Stay& other) {
    if (other.from > other.to) return;
    if (stay.from > stay.to) {
      stay = other;
    } else {
      stay = {std::min(stay.from, other.from), std::max(stay.to, other.to)};
    }
  };
  join(side);
  for (const double middle : {low, high}) {
    Stay ball;
    cut_round(ball, Vector3(start - Vector3(0, 0, middle)), way, capsule.radius);
    join(ball);
  }
  return stay;
}

Stay stay_in(const scene::Hull& hull, const Vector3& start, const Vector3& way) {
  Stay stay;
  for (const scene::Polyhedron::Face& face : hull.polyhedron->faces) {
    const double height = face.normal.dot(start) - face.offset, climb = face.normal.dot(way);
    if (climb == 0) {
      if (height > 0) stay.never();
    } else if (climb < 0) {
      stay.cut(-height / climb, stay.to);
    } else {
      stay.cut(stay.from, -height / climb);
    }
  }
  return stay;
}

}  // namespace

std::optional<double> enter(const scene::Geometry& geometry, const Vector3& start,
                            const Vector3& end, double depth) {
  const Vector3 way = end - start;
  const double length = way.norm();
  if (!(length > 0)) return std::nullopt;
  const Stay stay =
      std::visit([&](const auto& shape) { return stay_in(shape, start, way); }, geometry);
  // A stay of no length is a touch from outside; the end of the segment is not part of it.
  if (!(stay.from <= stay.to) || stay.from >= 1 || stay.to <= 0) return std::nullopt;
  if (stay.from < -depth / length) return std::nullopt;
  return stay.from;
}

struct Rays::Parts {
  /// A collider.
  struct Solid {
    scene::Geometry geometry;
    std::size_t link = 0;    // into State::links
    bool is_placed = false;  // it has a pose
    math::Pose pose;         // X_WL of the last update
    btVector3 low, high;     // corners of the box about it [m]
    std::size_t entity = 0;
  };
  /// Solids that follow each other and share a leaf of the tree: of an entity that moves some, of
  /// one that stands each alone.
  struct Group {
    std::size_t entity = 0;
    std::size_t first = 0, count = 0;  // of its solids
    btDbvtNode* leaf = nullptr;
    bool removed = false;
    bool leaves = false;  // its volume is too small
    double moved = 0;     // by so much since the last update [m]
    btVector3 low, high;  // corners of the box about its solids [m]
  };

  bool has_floor = false;
  std::size_t entities = 0;
  std::size_t links = 0, last_links = 0;  // of all, of the last entity
  std::vector<Solid> solids;
  std::vector<Group> groups;
  std::vector<std::size_t> fresh;  // groups of an update that are not yet in the tree
  btDbvt tree;

  bool place(Solid& solid, const math::Pose& pose);
  void place(Group& group, const world::State& state);
};

namespace {

/// Whether the tree can have a box. Bullet builds a tree by comparing sizes, and writes outside of
/// its list if all are infinite.
bool is_bounded(const btVector3& low, const btVector3& high) {
  constexpr double farthest = 1e30;  // [m], whose third power is finite; no ray is as long
  const auto is_near = [](const btVector3& v) {
    return std::abs(v.x()) < farthest && std::abs(v.y()) < farthest && std::abs(v.z()) < farthest;
  };
  return is_near(low) && is_near(high);
}

/// Nodes of a search of the thread.
btAlignedObjectArray<const btDbvtNode*>& search_stack() {
  static thread_local btAlignedObjectArray<const btDbvtNode*> stack;
  return stack;
}

bool same(const math::Pose& a, const math::Pose& b) {
  return a.position == b.position && a.orientation.coeffs() == b.orientation.coeffs();
}

}  // namespace

Rays::Rays(const scene::Physics& physics) : parts_(std::make_unique<Parts>()) {
  parts_->has_floor = physics.floor.has_value();
}
Rays::~Rays() = default;
Rays::Rays(Rays&&) noexcept = default;

void Rays::add(const scene::Entity& entity) {
  Parts& p = *parts_;
  for (std::size_t i = 0; i < entity.links.size(); ++i) {
    const scene::Link& link = entity.links[i];
    if (!link.collides) continue;
    const bool joins = entity.movable && !p.groups.empty() &&
                       p.groups.back().entity == p.entities &&
                       p.groups.back().count < most_in_group;
    if (!joins) {
      Parts::Group& group = p.groups.emplace_back();
      group.entity = p.entities;
      group.first = p.solids.size();
    }
    ++p.groups.back().count;
    Parts::Solid& solid = p.solids.emplace_back();
    solid.geometry = link.geometry;
    solid.link = p.links + i;
    solid.entity = p.entities;
  }
  p.last_links = entity.links.size();
  p.links += p.last_links;
  p.entities += 1;
}

void Rays::remove(std::size_t entity) {
  Parts& p = *parts_;
  for (Parts::Group& group : p.groups) {
    if (group.entity != entity) continue;
    if (group.leaf) p.tree.remove(group.leaf);
    group.leaf = nullptr;
    group.removed = true;
  }
}

void Rays::take_back() {
  Parts& p = *parts_;
  p.entities -= 1;
  while (!p.groups.empty() && p.groups.back().entity == p.entities) {
    if (p.groups.back().leaf) p.tree.remove(p.groups.back().leaf);
    p.solids.resize(p.groups.back().first);
    p.groups.pop_back();
  }
  p.links -= p.last_links;
}

/// Puts a solid to a pose.
/// @return  false: the pose is not finite, and it stays where it was
bool Rays::Parts::place(Solid& solid, const math::Pose& pose) {
  if (!pose.position.allFinite() || !pose.orientation.coeffs().allFinite()) return false;
  const scene::Bounds own = scene::bounds(solid.geometry);
  const Vector3 half = pose.orientation.toRotationMatrix().cwiseAbs() * (own.size() / 2) +
                       Vector3::Constant(rounding_margin);
  const Vector3 center = pose * own.center();
  solid.pose = pose;
  solid.low = to_bullet(Vector3(center - half));
  solid.high = to_bullet(Vector3(center + half));
  solid.is_placed = is_bounded(solid.low, solid.high);
  return true;
}

/// Puts the solids of a group to their poses. It changes nothing of other groups.
void Rays::Parts::place(Group& group, const world::State& state) {
  group.leaves = false;
  group.moved = 0;
  if (group.removed) return;
  bool any = false;
  for (std::size_t i = group.first; i < group.first + group.count; ++i) {
    const math::Pose& pose = state.links[solids[i].link].pose;
    if (solids[i].is_placed && same(pose, solids[i].pose)) continue;
    const double moved = (pose.position - solids[i].pose.position).norm();
    if (!place(solids[i], pose)) continue;
    any = true;
    group.moved = std::max(group.moved, moved);
  }
  if (!any) return;
  group.low.setValue(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
  group.high = -group.low;
  for (std::size_t i = group.first; i < group.first + group.count; ++i) {
    if (!solids[i].is_placed) continue;
    group.low.setMin(solids[i].low);
    group.high.setMax(solids[i].high);
  }
  if (!is_bounded(group.low, group.high)) return;
  group.leaves =
      !group.leaf || !group.leaf->volume.Contain(btDbvtVolume::FromMM(group.low, group.high));
}

void Rays::update(const world::State& state, dynamics::Team* team) {
  constexpr std::size_t block = 16;  // groups that a thread takes at once
  Parts& p = *parts_;
  dynamics::share_in_blocks(team, p.groups.size(), block,
                            [&](std::size_t i, unsigned) { p.place(p.groups[i], state); });
  const auto volume = [](const Parts::Group& group) {
    const btVector3 size = group.high - group.low;
    const double most = margin_share * size[size.minAxis()];
    const double margin =
        std::max(volume_margin, group.leaf ? std::min(ticks_ahead * group.moved, most) : 0.0);
    const btVector3 around(margin, margin, margin);
    return btDbvtVolume::FromMM(group.low - around, group.high + around);
  };
  p.fresh.clear();
  for (std::size_t i = 0; i < p.groups.size(); ++i) {
    Parts::Group& group = p.groups[i];
    if (!group.leaves) continue;
    if (!group.leaf) {
      p.fresh.push_back(i);
      continue;
    }
    btDbvtVolume bounds = volume(group);
    p.tree.update(group.leaf, bounds);
  }
  in_bit_reversed_order(p.fresh.size(), [&](std::size_t i) {
    Parts::Group& group = p.groups[p.fresh[i]];
    group.leaf = p.tree.insert(volume(group), nullptr);
    group.leaf->dataAsInt = static_cast<int>(p.fresh[i]);
  });
  if (!p.fresh.empty()) return p.tree.optimizeTopDown();
  p.tree.optimizeIncremental(1 + static_cast<int>(p.groups.size() / 64));
}

/// One ray on its way: the closest of what it meets; of equally close ones the first in scene
/// order.
struct Rays::Flight : btDbvt::ICollide {
  Flight(const Parts& parts_in, const RayQuery& query_in)
      : parts(parts_in), query(query_in), way(query.end - query.start), length(way.norm()) {
    valid = length > 0 && std::isfinite(length);
    if (!valid) return;
    const btVector3 unit = to_bullet(Vector3(way / length));
    for (int i = 0; i < 3; ++i) {
      inverse_way[i] = std::abs(unit[i]) < 1e-30 ? btScalar(BT_LARGE_FLOAT) : 1 / unit[i];
      signs[i] = inverse_way[i] < 0;
    }
    start = to_bullet(query.start);
  }

  void Process(const btDbvtNode* leaf) override {
    const Parts::Group& group = parts.groups[static_cast<std::size_t>(leaf->dataAsInt)];
    if (std::ranges::find(query.ignored, group.entity) != query.ignored.end()) return;
    for (std::size_t i = group.first; i < group.first + group.count; ++i) meet(parts.solids[i]);
  }

  void meet(const Parts::Solid& solid) {
    if (!solid.is_placed || !passes(solid)) return;
    const math::Pose into = math::inverse(solid.pose);
    const auto at = enter(solid.geometry, into * query.start, into * query.end, skin);
    if (!at) return;
    if (*at < share || (*at == share && met && solid.link < met->link)) {
      share = *at;
      met = &solid;
    }
  }

  bool passes(const Parts::Solid& solid) const {
    const btVector3 bounds[2] = {solid.low, solid.high};
    btScalar from = 1;
    return btRayAabb2(start, inverse_way, signs, bounds, from, 0, length);
  }

  std::optional<RayHit> end() const {
    std::optional<RayHit> hit;
    if (met) hit = RayHit{std::max(0.0, share) * length, met->entity};
    if (query.sees_floor && parts.has_floor && query.start.z() >= -skin && way.z() < 0) {
      const double distance = std::max(0.0, query.start.z()) / -way.z() * length;
      if (distance < length && (!hit || distance < hit->distance)) hit = RayHit{distance, {}};
    }
    return hit;
  }

  const Parts& parts;
  const RayQuery& query;
  Vector3 way;
  double length;  // [m]
  bool valid = false;
  btVector3 start, inverse_way;
  unsigned signs[3];
  double share = 1;
  const Parts::Solid* met = nullptr;
};

std::optional<RayHit> Rays::cast(const RayQuery& query) const {
  const Parts& p = *parts_;
  Flight flight(p, query);
  if (!flight.valid) return std::nullopt;
  const btVector3 zero(0, 0, 0);
  p.tree.rayTestInternal(p.tree.m_root, flight.start, to_bullet(query.end), flight.inverse_way,
                         flight.signs, flight.length, zero, zero, search_stack(), flight);
  return flight.end();
}

/// Goes through the tree itself, because Bullet's search cannot end when there are too many.
void Rays::find(const Vector3& low, const Vector3& high, std::span<const std::size_t> ignored,
                Candidates& out) const {
  constexpr std::size_t few = 32;
  const Parts& p = *parts_;
  const btDbvtVolume box = btDbvtVolume::FromMM(to_bullet(low), to_bullet(high));
  out.colliders.clear();
  auto& stack = search_stack();
  stack.resize(0);
  if (p.tree.m_root) stack.push_back(p.tree.m_root);
  while (stack.size() > 0 && out.colliders.size() <= few) {
    const btDbvtNode& node = *stack[stack.size() - 1];
    stack.pop_back();
    if (!Intersect(node.volume, box)) continue;
    if (node.isinternal()) {
      stack.push_back(node.childs[0]);
      stack.push_back(node.childs[1]);
      continue;
    }
    const Parts::Group& group = p.groups[static_cast<std::size_t>(node.dataAsInt)];
    if (std::ranges::find(ignored, group.entity) != ignored.end()) continue;
    for (std::size_t i = group.first; i < group.first + group.count; ++i) {
      const Parts::Solid& solid = p.solids[i];
      if (solid.is_placed && Intersect(btDbvtVolume::FromMM(solid.low, solid.high), box))
        out.colliders.push_back(i);
    }
  }
  out.are_few = out.colliders.size() <= few;
}

std::optional<RayHit> Rays::cast(const RayQuery& query, const Candidates& candidates) const {
  if (!candidates.are_few) return cast(query);
  const Parts& p = *parts_;
  Flight flight(p, query);
  if (!flight.valid) return std::nullopt;
  for (const std::size_t collider : candidates.colliders) flight.meet(p.solids[collider]);
  return flight.end();
}

}  // namespace ziggurat::physics
