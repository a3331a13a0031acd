// SPDX-License-Identifier: MIT
#pragma once
// Seeded random streams, one per purpose, so that drawing more in one place never
// changes what another place sees. Results are the same on every platform: the
// engine is the standard's mt19937_64 and the distributions are ours or Boost's,
// never the standard library's, whose algorithms are not specified.

#include <cstdint>
#include <random>
#include <string_view>
#include <vector>

namespace ziggurat::math {

class Archive;

class RandomStream {
 public:
  /// @param seed     the run's seed
  /// @param purpose  names the stream, for example "distribute" or "proximity/robot0"
  RandomStream(std::uint64_t seed, std::string_view purpose);

  /// Uniform real in [min, max]; equal bounds give the constant without drawing.
  double uniform(double min, double max);

  /// Normal with the given mean and standard deviation (>= 0).
  double gaussian(double mean, double standard_deviation);

  /// Archives the position in the stream.
  void archive(Archive& archive);

 private:
  std::mt19937_64& engine();

  std::uint64_t seed_;
  std::vector<std::mt19937_64> engine_;  // one, from the first draw on: it takes 2.5 kB
};

}  // namespace ziggurat::math
