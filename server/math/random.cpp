#include "math/random.h"

#include <xxhash.h>

#include <boost/random/normal_distribution.hpp>

namespace ziggurat::math {

RandomStream::RandomStream(std::uint64_t seed, std::string_view purpose)
    : engine_(XXH64(purpose.data(), purpose.size(), seed)) {}

double RandomStream::uniform(double min, double max) {
  if (min == max) return min;
  constexpr double unit = 1.0 / static_cast<double>((1ULL << 53) - 1);
  return min + (max - min) * (static_cast<double>(engine_() >> 11) * unit);
}

double RandomStream::gaussian(double mean, double standard_deviation) {
  return boost::random::normal_distribution<double>(mean, standard_deviation)(engine_);
}

}  // namespace ziggurat::math
