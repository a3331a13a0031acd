// SPDX-License-Identifier: MIT
#include "script/random_stream.h"

#include <xxhash.h>

#include <algorithm>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/poisson_distribution.hpp>
#include <cmath>

namespace ziggurat::lua {

// Not the standard library's distributions: their algorithms are not specified.

RandomStream::RandomStream(std::uint64_t seed, std::string_view purpose)
    : seed_(XXH64(purpose.data(), purpose.size(), seed)) {}

std::mt19937_64& RandomStream::engine() {
  if (!engine_) engine_ = std::make_unique<std::mt19937_64>(seed_);
  return *engine_;
}

std::uint64_t RandomStream::bits() { return engine()(); }

double RandomStream::unit() { return static_cast<double>(engine()() >> 11) * 0x1p-53; }

double RandomStream::uniform(double min, double max) {
  constexpr double largest = static_cast<double>((1ULL << 53) - 1);
  const double part = static_cast<double>(engine()() >> 11) / largest;
  // Not min + (max - min) * part: the difference may overflow.
  return std::clamp(min * (1 - part) + max * part, min, max);
}

double RandomStream::exponential(double mean) { return -std::log(1 - unit()) * mean; }

double RandomStream::gaussian(double standard_deviation, double mean) {
  return mean + standard_deviation * boost::random::normal_distribution<double>()(engine());
}

std::int64_t RandomStream::poisson(double mean) {
  if (mean <= 0) return 0;
  return boost::random::poisson_distribution<std::int64_t, double>(mean)(engine());
}

}  // namespace ziggurat::lua
