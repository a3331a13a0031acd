// SPDX-License-Identifier: MIT
#pragma once
// Statistics of a controller's response times, computed from all its reactions. Percentiles are
// exact.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "network/reactions.h"

namespace ziggurat::reports {

/// Bins of a histogram of times: bin i is from least * 10^(i/20) on, the last has no end.
namespace bins {
inline constexpr std::size_t count = 160;
inline constexpr double least = 1e-6;  ///< [s]; shorter times are in bin 0
std::size_t of(double seconds);
double begin_of(std::size_t bin);  ///< [s]
}  // namespace bins

/// Percentiles of wall times [s].
struct Percentiles {
  double p50 = 0, p90 = 0, p99 = 0, p999 = 0, max = 0;
};
/// Each is the smallest of the values that at least this share of them does not exceed; 0 without
/// values.
/// @param values  get sorted
Percentiles percentiles(std::vector<double>& values);

struct Statistics {
  std::uint64_t in_time = 0, late = 0, unanswered = 0;  ///< reactions
  Percentiles wall_s;             ///< of all reactions, late and unanswered ones included
  double jitter_s = 0;            ///< mean change of the time from an observation to the next one
  std::uint64_t ticks = 0;        ///< at which there was any reaction
  std::uint64_t misses = 0;       ///< ticks at which a reaction was late or none
  std::uint64_t longest_run = 0;  ///< of misses at ticks in a row
  std::vector<network::Reaction> worst;                ///< the five longest, longest first
  std::array<std::uint64_t, bins::count> histogram{};  ///< of all reactions

  std::uint64_t count() const { return in_time + late + unanswered; }
};

/// @param reactions  of one controller, by world, tick and robot
Statistics measure(std::span<const network::Reaction> reactions);

}  // namespace ziggurat::reports
