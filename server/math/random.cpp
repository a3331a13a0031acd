// SPDX-License-Identifier: MIT
#include "math/random.h"

#include <xxhash.h>

#include <array>
#include <bit>
#include <boost/random/normal_distribution.hpp>
#include <type_traits>

#include "math/archive.h"

namespace ziggurat::math {

RandomStream::RandomStream(std::uint64_t seed, std::string_view purpose)
    : seed_(XXH64(purpose.data(), purpose.size(), seed)) {}

std::mt19937_64& RandomStream::engine() {
  if (engine_.empty()) engine_.emplace_back(seed_);
  return engine_.front();
}

double RandomStream::uniform(double min, double max) {
  if (min == max) return min;
  constexpr double unit = 1.0 / static_cast<double>((1ULL << 53) - 1);
  return min + (max - min) * (static_cast<double>(engine()() >> 11) * unit);
}

double RandomStream::gaussian(double mean, double standard_deviation) {
  return boost::random::normal_distribution<double>(mean, standard_deviation)(engine());
}

// The words of the standard's engine and the place of the next, as libstdc++ keeps them. The
// standard offers them as text only, which takes a hundred times as long.
void RandomStream::archive(Archive& archive) {
  constexpr std::size_t words = std::mt19937_64::state_size;
  using Words = std::array<std::uint64_t, words + 1>;
  static_assert(std::is_trivially_copyable_v<std::mt19937_64>);
  Words state = std::bit_cast<Words>(engine_.empty() ? std::mt19937_64(seed_) : engine_.front());
  archive("engine", state);
  archive.require(state[words] <= words, "has a place beyond its words");
  const auto told = std::bit_cast<std::mt19937_64>(state);
  if (told != (engine_.empty() ? std::mt19937_64(seed_) : engine_.front())) engine() = told;
}

}  // namespace ziggurat::math
