// SPDX-License-Identifier: MIT
#include "simulation/placement.h"

#include <fmt/format.h>

#include "math/random.h"
#include "physics/placement.h"
#include "scene/values.h"

namespace ziggurat::simulation {
namespace {

using math::Vector3;

/// Draws the triples of one generator, in order.
class Draw {
 public:
  Draw(const scene::Generator& generator, math::RandomStream& random)
      : generator_(generator), random_(random) {}

  Vector3 next() {
    const Vector3 &first = generator_.first, &second = generator_.second;
    switch (generator_.method) {
      case scene::DistributionMethod::constant:
        return first;
      case scene::DistributionMethod::grid:
        return grid_cell(count_++);
      case scene::DistributionMethod::uniform: {
        Vector3 value;
        for (int i = 0; i < 3; ++i) value[i] = random_.uniform(first[i], second[i]);
        return value;
      }
      case scene::DistributionMethod::gaussian: {
        Vector3 value;
        for (int i = 0; i < 3; ++i) value[i] = random_.gaussian(first[i], second[i]);
        return value;
      }
    }
    return first;
  }

 private:
  /// From the positive corner, x fastest, decreasing.
  Vector3 grid_cell(std::size_t i) const {
    const auto& layout = generator_.layout;
    const std::size_t cell[3] = {i % layout[0], i / layout[0] % layout[1],
                                 i / (std::size_t{layout[0]} * layout[1])};
    Vector3 value;
    for (int k = 0; k < 3; ++k) {
      value[k] = generator_.first[k] +
                 generator_.second[k] * ((layout[k] - 1) / 2.0 - static_cast<double>(cell[k]));
    }
    return value;
  }

  const scene::Generator& generator_;
  math::RandomStream& random_;
  std::size_t count_ = 0;
};

/// Places found, and attempts to find more.
class Search {
 public:
  Search(const scene::Scene& scene, const SearchLimits& limits, const TellStep& tell)
      : scene(scene), limits(limits), tell_(tell) {
    for (const scene::Distribution& group : scene.distributions) all_ += group.quantity;
  }

  const scene::Scene& scene;
  const SearchLimits limits;

  /// @param effort  of this attempt, see physics::Placement
  void fail(std::size_t effort) {
    constexpr std::size_t between_messages = 10'000;
    effort_ += effort;
    if (++attempts_ % between_messages == 0) tell_now();
  }
  void succeed() {
    constexpr std::size_t between_messages = 100;
    if (++placed_ % between_messages == 0) tell_now();
  }

  bool is_out_of_attempts() const { return attempts_ >= limits.attempts; }
  bool is_out_of_effort() const { return effort_ >= limits.effort; }

 private:
  void tell_now() const {
    if (tell_) tell_(Step::placing, placed_, all_);
  }

  const TellStep& tell_;
  std::size_t all_ = 0, attempts_ = 0, placed_ = 0;
  std::size_t effort_ = 0;  ///< of attempts that failed
};

/// Why it ends before 'max_trials' says; empty if it does not.
std::string limit_of(const Search& search) {
  if (search.is_out_of_attempts())
    return fmt::format(", and a scene has {} in all", search.limits.attempts);
  if (search.is_out_of_effort()) return ", each so long that a scene has no more";
  return {};
}

/// @param tried   for this entity
/// @param placed  entities of this group
[[noreturn]] void no_place(const Search& search, const scene::Distribution& group,
                           const std::string& id, std::size_t tried, unsigned placed,
                           const std::string& other) {
  const bool is_grid = group.position.method == scene::DistributionMethod::grid;
  const std::string limit = limit_of(search);
  scene::Problem problem;
  problem.file = search.scene.files.empty() ? "" : search.scene.files[group.where.file];
  problem.where = group.where;
  if (is_grid) {
    problem.text = fmt::format(
        "<distribute>: '{}' overlaps '{}' in its grid cell, after {} of {} were placed; make "
        "'distances' larger or "
        "move what stands in the way",
        id, other, placed, group.quantity);
  } else {
    problem.text = fmt::format(
        "<distribute>: no free place for '{}' in {} attempts{}, after {} of {} were placed (the "
        "last attempt "
        "overlapped '{}'); widen the range{} place fewer{}",
        id, tried, limit, placed, group.quantity, other, limit.empty() ? "," : " or",
        limit.empty() ? " or raise 'max_trials'" : "");
  }
  throw scene::SceneError({problem});
}

/// Ends a search that takes too long though it finds places.
void check_effort(const Search& search, const scene::Distribution& group, unsigned placed,
                  std::size_t effort) {
  if (effort < search.limits.all_effort) return;
  scene::Problem problem;
  problem.file = search.scene.files.empty() ? "" : search.scene.files[group.where.file];
  problem.where = group.where;
  problem.text = fmt::format(
      "<distribute>: it takes too long to find places, after {} of {} were found: too many bodies, "
      "or parts of them, are "
      "near each other, or are long and thin; place fewer, or farther apart",
      placed, group.quantity);
  throw scene::SceneError({problem});
}

void distribute(Search& search, const scene::Distribution& group, math::RandomStream& random,
                physics::Placement& placement, std::vector<scene::Entity>& entities) {
  Draw position(group.position, random), orientation(group.orientation, random);
  const bool grid = group.position.method == scene::DistributionMethod::grid ||
                    group.orientation.method == scene::DistributionMethod::grid;
  const std::size_t most = grid ? 1 : std::size_t{group.max_trials} + 1;
  for (unsigned i = 0; i < group.quantity; ++i) {
    scene::Entity entity = group.entity;
    entity.id += std::to_string(std::size_t{group.base_num} + i);
    for (std::size_t tried = 1;; ++tried) {
      entity.pose.position = position.next();
      entity.pose.orientation = scene::orientation_from_degrees(orientation.next());
      const std::size_t before = placement.effort();
      const std::string other = placement.overlapped_by(entity);
      if (other.empty()) break;
      search.fail(placement.effort() - before);
      if (tried == most || search.is_out_of_attempts() || search.is_out_of_effort()) {
        no_place(search, group, entity.id, tried, i, other);
      }
    }
    placement.add(entity);
    entities.push_back(std::move(entity));
    search.succeed();
    check_effort(search, group, i + 1, placement.effort());
  }
}

}  // namespace

std::vector<scene::Entity> place_entities(const scene::Scene& scene, std::uint64_t seed,
                                          const TellStep& tell, SearchLimits limits) {
  std::vector<scene::Entity> entities = scene.entities;
  physics::Placement placement;
  if (!scene.distributions.empty()) {
    for (const scene::Entity& entity : entities) placement.add(entity);
  }
  Search search(scene, limits, tell);
  math::RandomStream random(seed, "distribute");
  for (const scene::Distribution& group : scene.distributions) {
    distribute(search, group, random, placement, entities);
  }
  return entities;
}

}  // namespace ziggurat::simulation
