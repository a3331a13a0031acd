#pragma once
// Histogram of a controller's response times since the run began.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace ziggurat::network {

/// Histogram with a fixed number of bins. Bin i counts times from least * growth^i on [s]. The
/// first bin also counts shorter times, the last one longer times.
struct AnswerTimes {
  static constexpr double least = 1e-5;                 ///< [s]
  static constexpr double growth = 1.4142135623730951;  ///< two bins double it
  std::array<std::uint64_t, 48> counts{};               ///< up to 2 minutes

  void add(double seconds) {
    const double bin = seconds > least ? 2 * std::log2(seconds / least) : 0;
    ++counts[std::min(static_cast<std::size_t>(bin), counts.size() - 1)];
  }
};

}  // namespace ziggurat::network
