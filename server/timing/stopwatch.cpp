// SPDX-License-Identifier: MIT
#include "timing/stopwatch.h"

#include <numeric>

namespace ziggurat::timing {

PhaseTimes& PhaseTimes::operator+=(const PhaseTimes& other) {
  for (std::size_t i = 0; i < phase_count; ++i) seconds[i] += other.seconds[i];
  return *this;
}

double PhaseTimes::sum(Phase first, Phase last) const {
  const auto place = [&](Phase phase) { return seconds.begin() + static_cast<int>(phase); };
  return std::accumulate(place(first), place(last) + 1, 0.0);
}

void Stopwatch::add(Stopwatch& other) {
  for (std::size_t i = 0; i < phase_count; ++i) counts_[i] += other.counts_[i];
  other.counts_ = {};
}

void Stopwatch::divide_like(const Stopwatch& other) {
  const std::uint64_t now = clock_counts();
  const auto all = std::accumulate(other.counts_.begin(), other.counts_.end(), std::uint64_t{0});
  if (all == 0) return;
  const double share = static_cast<double>(now - last_) / static_cast<double>(all);
  std::uint64_t divided = 0;
  for (std::size_t i = 0; i < phase_count; ++i) {
    const auto part = static_cast<std::uint64_t>(share * static_cast<double>(other.counts_[i]));
    counts_[i] += part;
    divided += part;
  }
  last_ += divided;  // what rounding leaves goes to the present phase
}

PhaseTimes Stopwatch::take() {
  stop();
  const auto now = std::chrono::steady_clock::now();
  const auto counted = static_cast<double>(last_ - first_);
  const double elapsed = std::chrono::duration<double>(now - since_).count();
  PhaseTimes times;
  for (std::size_t i = 0; i < phase_count; ++i)
    times.seconds[i] = counted > 0 ? elapsed / counted * static_cast<double>(counts_[i]) : 0;
  counts_ = {};
  first_ = last_;
  since_ = now;
  return times;
}

}  // namespace ziggurat::timing
