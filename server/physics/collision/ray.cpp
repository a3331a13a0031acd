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

namespace ziggurat::physics {
namespace {

using math::Vector3;

constexpr double skin = 1e-4;  // [m]
// Margins of bounding volumes [m]: with the first they are made, and made anew once less than the
// second is left. So vibration at rest leaves the tree alone.
constexpr double volume_margin = 1e-3;
constexpr double rounding_margin = 1e-4;

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
  /// A collider, as the tree refers to it.
  struct Solid {
    scene::Geometry geometry;
    std::size_t entity = 0;
    std::size_t link = 0;  // into State::links
    math::Pose pose;       // X_WL of the last update
    btDbvtNode* leaf = nullptr;
    bool removed = false;
  };

  bool has_floor = false;
  std::size_t entities = 0;
  std::size_t links = 0, last_links = 0;  // of all, of the last entity
  std::vector<Solid> solids;
  std::vector<std::size_t> fresh;  // solids of an update that are not yet in the tree
  btDbvt tree;
  mutable btAlignedObjectArray<const btDbvtNode*> stack;
};

namespace {

btDbvtVolume volume(const scene::Geometry& geometry, const math::Pose& pose, double margin) {
  const scene::Bounds own = scene::bounds(geometry);
  const Vector3 half =
      pose.orientation.toRotationMatrix().cwiseAbs() * (own.size() / 2) + Vector3::Constant(margin);
  const Vector3 center = pose * own.center();
  return btDbvtVolume::FromCE(to_bullet(center), to_bullet(half));
}

/// Whether the tree can have it. Bullet builds a tree by comparing sizes, and writes outside of its
/// list if all are infinite.
bool is_bounded(const btDbvtVolume& volume) {
  constexpr double farthest = 1e30;  // [m], whose third power is finite; no ray is as long
  const auto is_near = [](const btVector3& v) {
    return std::abs(v.x()) < farthest && std::abs(v.y()) < farthest && std::abs(v.z()) < farthest;
  };
  return is_near(volume.Mins()) && is_near(volume.Maxs());
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
    if (link.collides)
      p.solids.push_back({link.geometry, p.entities, p.links + i, {}, nullptr, false});
  }
  p.last_links = entity.links.size();
  p.links += p.last_links;
  p.entities += 1;
}

void Rays::remove(std::size_t entity) {
  Parts& p = *parts_;
  for (Parts::Solid& solid : p.solids) {
    if (solid.entity != entity) continue;
    if (solid.leaf) p.tree.remove(solid.leaf);
    solid.leaf = nullptr;
    solid.removed = true;
  }
}

void Rays::take_back() {
  Parts& p = *parts_;
  p.entities -= 1;
  while (!p.solids.empty() && p.solids.back().entity == p.entities) {
    if (p.solids.back().leaf) p.tree.remove(p.solids.back().leaf);
    p.solids.pop_back();
  }
  p.links -= p.last_links;
}

void Rays::update(const world::State& state) {
  Parts& p = *parts_;
  p.fresh.clear();
  for (std::size_t i = 0; i < p.solids.size(); ++i) {
    Parts::Solid& solid = p.solids[i];
    if (solid.removed) continue;
    const math::Pose& pose = state.links[solid.link].pose;
    if (solid.leaf && same(pose, solid.pose)) continue;
    if (!pose.position.allFinite() || !pose.orientation.coeffs().allFinite()) continue;
    solid.pose = pose;
    if (solid.leaf && solid.leaf->volume.Contain(volume(solid.geometry, pose, rounding_margin))) {
      continue;
    }
    btDbvtVolume bounds = volume(solid.geometry, pose, volume_margin);
    if (!is_bounded(bounds)) continue;
    if (!solid.leaf) {
      p.fresh.push_back(i);
      continue;
    }
    p.tree.update(solid.leaf, bounds);
  }
  in_bit_reversed_order(p.fresh.size(), [&](std::size_t i) {
    Parts::Solid& solid = p.solids[p.fresh[i]];
    solid.leaf = p.tree.insert(volume(solid.geometry, solid.pose, volume_margin), nullptr);
    solid.leaf->dataAsInt = static_cast<int>(p.fresh[i]);
  });
  if (!p.fresh.empty()) return p.tree.optimizeTopDown();
  p.tree.optimizeIncremental(1 + static_cast<int>(p.solids.size() / 64));
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
    const Parts::Solid& solid = parts.solids[static_cast<std::size_t>(leaf->dataAsInt)];
    if (std::ranges::find(query.ignored, solid.entity) != query.ignored.end()) return;
    const math::Pose into = math::inverse(solid.pose);
    const auto at = enter(solid.geometry, into * query.start, into * query.end, skin);
    if (!at) return;
    if (*at < share || (*at == share && met && solid.link < met->link)) {
      share = *at;
      met = &solid;
    }
  }

  bool passes(const btDbvtVolume& volume) const {
    const btVector3 bounds[2] = {volume.Mins(), volume.Maxs()};
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
                         flight.signs, flight.length, zero, zero, p.stack, flight);
  return flight.end();
}

/// Goes through the tree itself, because Bullet's search cannot end when there are too many.
void Rays::find(const Vector3& low, const Vector3& high, std::span<const std::size_t> ignored,
                Candidates& out) const {
  constexpr std::size_t few = 32;
  const Parts& p = *parts_;
  const btDbvtVolume box = btDbvtVolume::FromMM(to_bullet(low), to_bullet(high));
  out.colliders.clear();
  p.stack.resize(0);
  if (p.tree.m_root) p.stack.push_back(p.tree.m_root);
  while (p.stack.size() > 0 && out.colliders.size() <= few) {
    const btDbvtNode& node = *p.stack[p.stack.size() - 1];
    p.stack.pop_back();
    if (!Intersect(node.volume, box)) continue;
    if (node.isinternal()) {
      p.stack.push_back(node.childs[0]);
      p.stack.push_back(node.childs[1]);
      continue;
    }
    const auto collider = static_cast<std::size_t>(node.dataAsInt);
    if (std::ranges::find(ignored, p.solids[collider].entity) == ignored.end())
      out.colliders.push_back(collider);
  }
  out.are_few = out.colliders.size() <= few;
}

std::optional<RayHit> Rays::cast(const RayQuery& query, const Candidates& candidates) const {
  if (!candidates.are_few) return cast(query);
  const Parts& p = *parts_;
  Flight flight(p, query);
  if (!flight.valid) return std::nullopt;
  for (const std::size_t collider : candidates.colliders) {
    const btDbvtNode* leaf = p.solids[collider].leaf;
    if (flight.passes(leaf->volume)) flight.Process(leaf);
  }
  return flight.end();
}

}  // namespace ziggurat::physics
