// SPDX-License-Identifier: MIT
#include "simulation/scene_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "physics/placement.h"
#include "scene/additions.h"
#include "scene/values.h"

namespace ziggurat::simulation {
namespace {

using math::Vector3;

constexpr std::size_t most_compared = 5000;            // placed entities, for overlaps
constexpr std::size_t most_pairs = 100'000'000;        // of what may fall with what may hold it
constexpr std::size_t most_effort = 10'000'000;        // of physics::Placement
constexpr double deep = 1e-3;                          // in the floor [m]
constexpr double huge_movable = 10, huge_fixed = 100;  // times the arena's longest side
constexpr double far_joint = 10;                       // the same, from its links
constexpr double long_limit = 50;  // of a prismatic joint, times the entity's size
constexpr double long_link = 200;  // times the next longest of the entity

/// An axis-aligned box in W [m].
struct Extent {
  Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity());
  Vector3 high = -low;

  void add(const Extent& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
  bool meets(const Extent& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
};

Extent extent_of(const scene::Link& link, const math::Pose& pose) {
  Extent extent;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3 along = pose.orientation.conjugate() * Vector3::Unit(axis);
    extent.high[axis] = pose.position[axis] + scene::reach(link.geometry, along);
    extent.low[axis] = pose.position[axis] - scene::reach(link.geometry, -along);
  }
  return extent;
}

/// The first of a kind, and how many follow it.
struct Kind {
  std::optional<scene::Problem> first;
  std::size_t more = 0;
};

class SceneWarnings {
 public:
  SceneWarnings(const scene::Scene& scene, const Simulation& simulation)
      : scene_(scene), layout_(simulation.layout()), entities_(simulation.entities()) {
    for (std::size_t e = 0; e < entities_.size(); ++e) {
      Extent& extent = extents_.emplace_back();
      for (std::size_t l = 0; l < entities_[e].links.size(); ++l) {
        const scene::Link& link = entities_[e].links[l];
        if (!link.collides && entities_[e].kind != scene::EntityKind::light) continue;
        extent.add(
            extent_of(link, simulation.state().links[layout_.entities[e].links.begin + l].pose));
      }
    }
  }

  std::vector<scene::Problem> find() {
    check_sizes();
    check_joints();
    check_proportions();
    check_overlaps();
    check_floor();
    check_arena();
    check_gravity();
    check_floating();
    check_magnets();
    check_packets();
    std::vector<scene::Problem> problems;
    for (Kind* kind : {&size_, &far_, &proportion_, &overlap_, &in_floor_, &outside_, &falls_,
                       &floats_, &no_force_, &deaf_}) {
      if (!kind->first) continue;
      if (kind->more > 0) kind->first->text += fmt::format("; and {} more like this", kind->more);
      problems.push_back(std::move(*kind->first));
    }
    return problems;
  }

 private:
  void doubt(Kind& kind, const scene::Entity& entity, const std::string& text) {
    if (kind.first) {
      ++kind.more;
      return;
    }
    kind.first = {
        scene::Problem::Severity::warning, scene::file_of(scene_, entity.where), entity.where,
        fmt::format("{} {} {}", to_string(entity.kind), scene::in_quotes(entity.id), text)};
  }

  void check_sizes() {
    const double arena = scene_.arena.size.maxCoeff();
    for (const scene::Entity& entity : entities_) {
      for (const scene::Link& link : entity.links) {
        const double size = scene::bounds(link.geometry).size().maxCoeff();
        if (!(size > arena * (entity.movable ? huge_movable : huge_fixed))) continue;
        doubt(size_, entity,
              fmt::format("is {:.6g} m long, {:.3g} times the arena; lengths are in metres", size,
                          size / arena));
        break;
      }
    }
  }

  void check_joints() {
    const double arena = scene_.arena.size.maxCoeff();
    for (const scene::Entity& entity : entities_) {
      for (const scene::Joint& joint : entity.joints) {
        const double distance =
            std::max(joint.parent_frame.position.norm(), joint.child_frame.position.norm());
        if (!(distance > arena * far_joint)) continue;
        doubt(far_, entity,
              fmt::format("has joint {} {:.6g} m away from its link, {:.3g} times the arena; "
                          "lengths are in metres",
                          scene::in_quotes(joint.id), distance, distance / arena));
        break;
      }
    }
  }

  /// A link or a limit that is far longer than its entity: one of them has another unit.
  void check_proportions() {
    for (const scene::Entity& entity : entities_) {
      double longest = 0, next = 0, size = 0;
      const scene::Link* of = nullptr;
      for (const scene::Link& link : entity.links) {
        if (!link.collides) continue;
        const double length = scene::bounds(link.geometry).size().maxCoeff();
        size += length;
        next = std::max(next, std::min(length, longest));
        if (length > longest) longest = length, of = &link;
      }
      if (next > 0 && longest > long_link * next) {
        doubt(proportion_, entity,
              fmt::format(
                  "has link {} of {:.6g} m, {:.3g} times its next longest; lengths are in metres",
                  scene::in_quotes(of->id), longest, longest / next));
        continue;
      }
      for (const scene::Joint& joint : entity.joints) {
        if (joint.type != scene::JointType::prismatic || !joint.limit) continue;
        const double limit = std::max(std::abs(joint.limit->lower), std::abs(joint.limit->upper));
        if (!(limit > long_limit * size)) continue;
        doubt(proportion_, entity,
              fmt::format("has joint {} with a limit of {:.6g} m, {:.3g} times the length of all "
                          "of its links; limits of "
                          "prismatic joints are in metres",
                          scene::in_quotes(joint.id), limit, limit / size));
        break;
      }
    }
  }

  /// Overlaps of entities that the scene places: distributed ones never overlap, and two that stand
  /// may.
  void check_overlaps() {
    if (scene_.entities.size() > most_compared) return;
    physics::Placement placement;
    for (const scene::Entity& entity : scene_.entities) {
      if (!entity.movable) placement.add(entity);
    }
    for (const scene::Entity& entity : scene_.entities) {
      if (!entity.movable) continue;
      if (placement.effort() > most_effort) return;
      if (const std::string other = placement.overlapped_by(entity); !other.empty()) {
        doubt(overlap_, entity,
              fmt::format("overlaps {} at the start, and both are pushed apart; move one of them",
                          scene::in_quotes(other)));
      }
      placement.add(entity);
    }
  }

  void check_floor() {
    if (!scene_.physics.floor) return;
    for (std::size_t e = 0; e < entities_.size(); ++e) {
      const double depth = -extents_[e].low.z();
      if (!entities_[e].movable || !(depth > deep)) continue;
      doubt(in_floor_, entities_[e],
            fmt::format("begins {:.3g} m deep in the floor, and is pushed out; raise it by as much",
                        depth));
    }
  }

  void check_arena() {
    const Vector3 half = scene_.arena.size / 2;
    Extent arena{scene_.arena.center - half, scene_.arena.center + half};
    if (half.z() == 0) {  // a flat world goes on upwards and downwards
      arena.low.z() = -std::numeric_limits<double>::infinity();
      arena.high.z() = std::numeric_limits<double>::infinity();
    }
    for (std::size_t e = 0; e < entities_.size(); ++e) {
      if (entities_[e].links.empty() || arena.meets(extents_[e])) continue;
      const Vector3& at = entities_[e].pose.position;
      doubt(outside_, entities_[e],
            fmt::format("begins outside of the arena, at {:.6g},{:.6g},{:.6g}; the arena is from "
                        "{:.6g},{:.6g},{:.6g} to {:.6g},{:.6g},{:.6g}",
                        at.x(), at.y(), at.z(), arena.low.x(), arena.low.y(), arena.low.z(),
                        arena.high.x(), arena.high.y(), arena.high.z()));
    }
  }

  /// Bodies that may fall without end: no floor, and nothing below that holds them.
  void check_gravity() {
    const bool falls = scene_.physics.gravity.value_or(0) > 0 && !scene_.physics.floor &&
                       scene_.physics.planes.empty();
    if (!falls) return;
    std::vector<Extent> fixed;
    for (std::size_t e = 0; e < entities_.size(); ++e) {
      if (!entities_[e].movable) fixed.push_back(extents_[e]);
    }
    const std::size_t movable = entities_.size() - fixed.size();
    if (fixed.size() * movable > most_pairs) return;
    for (std::size_t e = 0; e < entities_.size(); ++e) {
      if (!entities_[e].movable || entities_[e].flight) continue;
      Extent below = extents_[e];
      below.low.z() = -std::numeric_limits<double>::infinity();
      const auto holds = [&](const Extent& other) { return below.meets(other); };
      if (std::ranges::any_of(fixed, holds)) continue;
      doubt(falls_, entities_[e],
            "falls forever: there is gravity, but no floor; write <floor/> into <dynamics3d>, or "
            "remove <gravity>");
    }
  }

  /// Bodies that hang in the air because the scene has no gravity and does not say so.
  void check_floating() {
    if (scene_.physics.gravity || scene_.physics.magnetism || scene_.physics.flat) return;
    if (entities_.size() > most_compared) return;
    for (std::size_t e = 0; e < entities_.size(); ++e) {
      if (!entities_[e].movable || entities_[e].flight) continue;
      if (!(extents_[e].low.z() > deep)) continue;
      Extent below = extents_[e];
      below.low.z() -= deep;
      bool stands = is_in_a_plane(entities_[e]);
      for (std::size_t other = 0; other < entities_.size() && !stands; ++other) {
        stands = other != e && below.meets(extents_[other]);
      }
      if (stands) continue;
      doubt(floats_, entities_[e],
            "floats in the air: the scene has no gravity; write <gravity/> into <dynamics3d>, or "
            "<gravity g=\"0\"/> if "
            "that is meant");
    }
  }

  bool is_in_a_plane(const scene::Entity& entity) const {
    return std::ranges::any_of(scene_.physics.planes, [&](const scene::Plane& plane) {
      return entity.traction && entity.pose.position.z() == plane.elevation;
    });
  }

  /// Robots that never hear each other because their packets have other sizes.
  void check_packets() {
    std::map<std::size_t, const world::RangeAndBearingLayout*> first;  // of each medium
    for (const world::RangeAndBearingLayout& device : layout_.range_and_bearing) {
      const world::RangeAndBearingLayout& other =
          *first.emplace(device.medium, &device).first->second;
      if (other.data.count == device.data.count) continue;
      doubt(deaf_, entities_[device.mount.entity],
            fmt::format("sends {} bytes by range and bearing, and {} on the same medium {}: they "
                        "never hear each other; "
                        "give them the same size (data_size, of robots rab_data_size)",
                        device.data.count, scene::in_quotes(entities_[other.mount.entity].id),
                        other.data.count));
    }
    if (deaf_.first) deaf_.first->severity = scene::Problem::Severity::notice;
  }

  void check_magnets() {
    if (scene_.physics.magnetism) return;
    for (const scene::Entity& entity : entities_) {
      if (entity.devices.magnets.empty()) continue;
      doubt(no_force_, entity,
            "has magnets that have no force; write <magnetism/> into <dynamics3d>");
    }
  }

  const scene::Scene& scene_;
  const world::Layout& layout_;
  const std::vector<scene::Entity>& entities_;
  std::vector<Extent> extents_;  // at tick 0
  Kind size_, far_, proportion_, overlap_, in_floor_, outside_, falls_, floats_, no_force_, deaf_;
};

}  // namespace

std::vector<scene::Problem> scene_warnings(const scene::Scene& scene,
                                           const Simulation& simulation) {
  return SceneWarnings(scene, simulation).find();
}

}  // namespace ziggurat::simulation
