#include "simulation/finite.h"

#include <algorithm>
#include <cmath>

namespace ziggurat::simulation {
namespace {

/// 0 for finite numbers, otherwise NaN; so that one comparison does for many numbers.
double excess(const math::Pose& pose) {
  return 0.0 * (pose.position.sum() + pose.orientation.coeffs().sum());
}

double excess(const world::LinkState& link) {
  return excess(link.pose) + 0.0 * (link.velocity.sum() + link.angular_velocity.sum());
}

}  // namespace

std::optional<std::size_t> first_not_finite(const world::Layout& layout,
                                            const world::State& state) {
  double sum = 0;
  for (const math::Pose& origin : state.origins) sum += excess(origin);
  for (const world::LinkState& link : state.links) sum += excess(link);
  if (sum == 0) return std::nullopt;
  for (std::size_t i = 0; i < layout.entities.size(); ++i) {
    double of_entity = excess(state.origins[i]);
    const world::Range links = layout.entities[i].links;
    for (std::size_t l = links.begin; l < links.end(); ++l) of_entity += excess(state.links[l]);
    if (of_entity != 0) return i;
  }
  return std::nullopt;
}

}  // namespace ziggurat::simulation
