// SPDX-License-Identifier: MIT
#pragma once
// A stream of random numbers for one robot. It does not depend on the process that runs the robot,
// nor on other robots.

#include <cstdint>
#include <memory>
#include <random>
#include <string_view>

namespace ziggurat::lua {

class RandomStream {
 public:
  /// @param seed     of the run
  /// @param purpose  name of the stream, unique in the run, for example "lua/robot0"
  RandomStream(std::uint64_t seed, std::string_view purpose);

  std::uint64_t bits();                    ///< 64 independent bits
  double unit();                           ///< uniform in [0, 1), 53 bits
  double uniform(double min, double max);  ///< uniform in [min, max], both inclusive
  double exponential(double mean);
  double gaussian(double standard_deviation, double mean);
  /// @param mean  in [0, max_poisson_mean]
  std::int64_t poisson(double mean);

  static constexpr double max_poisson_mean = 1e15;

 private:
  std::mt19937_64& engine();
  std::uint64_t seed_;
  std::unique_ptr<std::mt19937_64> engine_;  // 2.5 kB: of a robot that uses it
};

}  // namespace ziggurat::lua
