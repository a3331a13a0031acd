// SPDX-License-Identifier: MIT
#include "network/delays.h"

#include <fmt/format.h>

#include <cmath>

#include "math/random.h"

namespace ziggurat::network {

Effect draw_effect(const Disturbance& disturbance, std::uint64_t seed, std::string_view path,
                   Direction direction, std::uint64_t tick) {
  if (!disturbance.any()) return {};
  const bool is_observation = direction == Direction::observations;
  math::RandomStream random(
      seed, fmt::format("{}/{}/{}", is_observation ? "delay" : "delay back", tick, path));
  const double chance = random.uniform(0, 1);  // drawn first, so that delays change no losses
  const double deviation = random.uniform(-1, 1);
  const auto jitter = static_cast<double>(disturbance.jitter.count());
  Effect effect;
  effect.delay = disturbance.latency + std::chrono::nanoseconds(std::llround(deviation * jitter));
  effect.is_lost = chance < disturbance.loss || disturbance.loss >= 1;
  return effect;
}

}  // namespace ziggurat::network
