// SPDX-License-Identifier: MIT
#include "random.h"

#include <xxhash.h>

#include <algorithm>
#include <string>

namespace assembly {
namespace {

std::uint64_t hash(const std::string& name, std::uint64_t seed) {
  return XXH64(name.data(), name.size(), seed);
}

}  // namespace

Random::Random(std::uint64_t seed, std::string_view robot)
    : engine_(hash("lua/robot.random/" + std::string(robot), seed)) {}

double Random::uniform(double min, double max) {
  constexpr double largest = static_cast<double>((1ULL << 53) - 1);
  const double part = static_cast<double>(engine_() >> 11) / largest;
  return std::clamp(min * (1 - part) + max * part, min, max);
}

std::int64_t Random::uniform_int(std::int64_t min, std::int64_t max) {
  const auto range = static_cast<std::uint64_t>(max - min);
  const auto wide = static_cast<unsigned __int128>(engine_()) * range;
  return min + static_cast<std::int64_t>(static_cast<std::uint64_t>(wide >> 64));
}

bool Random::bernoulli() { return static_cast<double>(engine_() >> 11) * 0x1p-53 < 0.5; }

}  // namespace assembly
