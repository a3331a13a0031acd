// SPDX-License-Identifier: MIT
#pragma once
// Percentiles of the most recent latencies, and the histogram of all response times.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "wire/request.h"

namespace ziggurat::network {

/// Window of fixed size: add() allocates nothing, and recent() sorts nothing.
class Latencies {
 public:
  static constexpr std::size_t remembered = 1000;

  /// Moves at most `remembered` numbers: an estimated 0.1 µs, whatever was added before.
  void add(double seconds);

  std::uint64_t count() const { return count_; }
  wire::Latency recent() const;  ///< of the last `remembered`

 private:
  std::array<float, remembered> recent_{};  // in order of arrival, the oldest overwritten
  std::array<float, remembered> sorted_{};  // the same, ascending
  std::uint64_t count_ = 0;
};

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
