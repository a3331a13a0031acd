#pragma once
// How long something took, again and again: percentiles of the last times, a histogram of all.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "wire/request.h"

namespace ziggurat::network {

/// Of fixed size: adding allocates nothing, and asking sorts nothing.
class Latencies {
 public:
  static constexpr std::size_t remembered = 1000;
  /// Bin i of the histogram is from least * growth^i on; the last has no end.
  static constexpr std::size_t bins = 160;
  static constexpr double least = 1e-6;                 ///< [s]; shorter times are in bin 0
  static constexpr double growth = 1.1220184543019633;  // 20 bins per factor of ten

  /// Moves at most `remembered` numbers: an estimated 0.1 µs, whatever was added before.
  /// @param tick  that it belongs to
  void add(double seconds, std::uint64_t tick);

  std::uint64_t count() const { return count_; }
  double max() const { return worst_[0].seconds; }  ///< of all [s]
  wire::Latency recent() const;                     ///< of the last `remembered`
  /// Of all, from the histogram: exact to a bin, never too small [s].
  double percentile(double share) const;
  const std::array<std::uint64_t, bins>& histogram() const { return histogram_; }
  static double begin_of(std::size_t bin);  ///< [s]

  struct Worst {
    double seconds = 0;
    std::uint64_t tick = 0;
  };
  /// The longest of all, longest first.
  std::vector<Worst> worst() const;

 private:
  std::array<float, remembered> recent_{};  // in order of arrival, the oldest overwritten
  std::array<float, remembered> sorted_{};  // the same, ascending
  std::array<std::uint64_t, bins> histogram_{};
  std::array<Worst, 5> worst_{};
  std::uint64_t count_ = 0;
};

}  // namespace ziggurat::network
