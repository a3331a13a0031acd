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

[[noreturn]] void no_place(const scene::Scene& scene, const scene::Distribution& group,
                           const std::string& id, unsigned placed, const std::string& other) {
  const bool grid = group.position.method == scene::DistributionMethod::grid;
  scene::Problem problem;
  problem.file = scene.files.empty() ? "" : scene.files[group.where.file];
  problem.where = group.where;
  problem.text =
      grid ? fmt::format(
                 "<distribute>: '{}' overlaps '{}' in its grid cell, after {} of {} were "
                 "placed; make 'distances' larger or move what stands in the way",
                 id, other, placed, group.quantity)
           : fmt::format(
                 "<distribute>: no free place for '{}' in {} attempts, after {} of {} were "
                 "placed (the last attempt overlapped '{}'); widen the range, place fewer "
                 "or raise 'max_trials'",
                 id, std::size_t{group.max_trials} + 1, placed, group.quantity, other);
  throw scene::SceneError({problem});
}

void distribute(const scene::Scene& scene, const scene::Distribution& group,
                math::RandomStream& random, physics::Placement& placement,
                std::vector<scene::Entity>& entities, const std::function<void()>& tell) {
  Draw position(group.position, random), orientation(group.orientation, random);
  const bool grid = group.position.method == scene::DistributionMethod::grid ||
                    group.orientation.method == scene::DistributionMethod::grid;
  const std::size_t attempts = grid ? 1 : std::size_t{group.max_trials} + 1;
  for (unsigned i = 0; i < group.quantity; ++i) {
    scene::Entity entity = group.entity;
    entity.id += std::to_string(std::size_t{group.base_num} + i);
    std::string other;
    for (std::size_t attempt = 0; attempt < attempts; ++attempt) {
      entity.pose.position = position.next();
      entity.pose.orientation = scene::orientation_from_degrees(orientation.next());
      other = placement.overlapped_by(entity);
      if (other.empty()) break;
    }
    if (!other.empty()) no_place(scene, group, entity.id, i, other);
    placement.add(entity);
    entities.push_back(std::move(entity));
    tell();
  }
}

}  // namespace

std::vector<scene::Entity> place(const scene::Scene& scene, std::uint64_t seed,
                                 const TellPlaced& tell) {
  std::vector<scene::Entity> entities = scene.entities;
  physics::Placement placement;
  if (!scene.distributions.empty()) {
    for (const scene::Entity& entity : entities) placement.add(entity);
  }
  constexpr std::size_t between = 100;  // entities
  std::size_t all = 0, placed = 0;
  for (const scene::Distribution& group : scene.distributions) all += group.quantity;
  const auto tell_one = [&] {
    if (++placed % between == 0 && tell) tell(placed, all);
  };
  math::RandomStream random(seed, "distribute");
  for (const scene::Distribution& group : scene.distributions) {
    distribute(scene, group, random, placement, entities, tell_one);
  }
  return entities;
}

}  // namespace ziggurat::simulation
