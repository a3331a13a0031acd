#pragma once
// Percentiles of the most recent latencies.

#include <array>
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

}  // namespace ziggurat::network
