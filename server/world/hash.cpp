#include "world/state.h"

namespace ziggurat::world {
namespace {

void add(math::Hash& hash, const math::Pose& pose) {
  hash.add(std::span(pose.position.data(), 3));
  hash.add(std::span(pose.orientation.coeffs().data(), 4));
}

}  // namespace

std::uint64_t hash(const State& state, const Observations& observations) {
  math::Hash hash;
  hash.add(state.tick);
  for (const auto& origin : state.origins) add(hash, origin);
  for (const auto& link : state.links) {
    add(hash, link.pose);
    hash.add(std::span(link.velocity.data(), 3));
    hash.add(std::span(link.angular_velocity.data(), 3));
  }
  hash.add(observations.joint_readings);
  return hash.digest();
}

}  // namespace ziggurat::world
