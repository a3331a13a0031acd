// SPDX-License-Identifier: MIT
#pragma once
// Random numbers of a robot: the same as those of robot.random in its Lua script.

#include <cstdint>
#include <random>
#include <string_view>

namespace assembly {

class Random {
 public:
  /// @param seed   of the run
  /// @param robot  its id
  Random(std::uint64_t seed, std::string_view robot);

  double uniform(double min, double max);                        ///< both inclusive
  std::int64_t uniform_int(std::int64_t min, std::int64_t max);  ///< max is excluded
  bool bernoulli();                                              ///< true half of the time

 private:
  std::mt19937_64 engine_;
};

}  // namespace assembly
