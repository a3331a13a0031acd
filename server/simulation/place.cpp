#include "simulation/place.h"

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
struct Search {
  const scene::Scene& scene;
  std::size_t most_attempts, all;
  const TellPlaced& tell;
  std::size_t attempts = 0, placed = 0;

  void tell_now() const {
    if (tell) tell(placed, all);
  }
};

/// @param tried   for this entity
/// @param placed  entities of this group
[[noreturn]] void no_place(const Search& search, const scene::Distribution& group, const std::string& id,
                           std::size_t tried, unsigned placed, const std::string& other) {
  const bool is_grid = group.position.method == scene::DistributionMethod::grid;
  const bool is_limit = search.attempts >= search.most_attempts;
  scene::Problem problem;
  problem.file = search.scene.files.empty() ? "" : search.scene.files[group.where.file];
  problem.where = group.where;
  if (is_grid) {
    problem.text = fmt::format(
        "<distribute>: '{}' overlaps '{}' in its grid cell, after {} of {} were placed; make 'distances' larger or "
        "move what stands in the way",
        id, other, placed, group.quantity);
  } else {
    problem.text = fmt::format(
        "<distribute>: no free place for '{}' in {} attempts{}, after {} of {} were placed (the last attempt "
        "overlapped '{}'); widen the range{} place fewer{}",
        id, tried,
        is_limit ? fmt::format(", and a scene has {} in all", search.most_attempts) : "", placed, group.quantity,
        other, is_limit ? " or" : ",", is_limit ? "" : " or raise 'max_trials'");
  }
  throw scene::SceneError({problem});
}

void distribute(Search& search, const scene::Distribution& group, math::RandomStream& random,
                physics::Placement& placement, std::vector<scene::Entity>& entities) {
  constexpr std::size_t between_placed = 100, between_attempts = 10'000;  // two messages
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
      const std::string other = placement.overlapped_by(entity);
      if (other.empty()) break;
      if (++search.attempts % between_attempts == 0) search.tell_now();
      if (tried == most || search.attempts >= search.most_attempts) {
        no_place(search, group, entity.id, tried, i, other);
      }
    }
    placement.add(entity);
    entities.push_back(std::move(entity));
    if (++search.placed % between_placed == 0) search.tell_now();
  }
}

}  // namespace

std::vector<scene::Entity> place(const scene::Scene& scene, std::uint64_t seed, const TellPlaced& tell,
                                 std::size_t most_attempts) {
  std::vector<scene::Entity> entities = scene.entities;
  physics::Placement placement;
  if (!scene.distributions.empty()) {
    for (const scene::Entity& entity : entities) placement.add(entity);
  }
  std::size_t all = 0;
  for (const scene::Distribution& group : scene.distributions) all += group.quantity;
  Search search{scene, most_attempts, all, tell};
  math::RandomStream random(seed, "distribute");
  for (const scene::Distribution& group : scene.distributions) {
    distribute(search, group, random, placement, entities);
  }
  return entities;
}

}  // namespace ziggurat::simulation
