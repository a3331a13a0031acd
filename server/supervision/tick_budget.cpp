// SPDX-License-Identifier: MIT
#include "supervision/tick_budget.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace ziggurat::supervision {
namespace {

/// Percentiles of times, which it reorders.
wire::Latency latency_of(std::vector<float>& times) {
  auto from = times.begin();
  const auto nth = [&](double share) {  // ascending shares
    const double place = std::ceil(share * static_cast<double>(times.size())) - 1;
    const auto item = times.begin() + static_cast<std::ptrdiff_t>(place);
    std::nth_element(from, item, times.end());
    from = item;
    return static_cast<double>(*item);
  };
  const double p50 = nth(0.5), p99 = nth(0.99);
  return {p50, p99, nth(1)};
}

}  // namespace

void TickBudget::add(const timing::PhaseTimes& tick) {
  auto& oldest = ticks_[count_++ % remembered];
  std::ranges::transform(tick.seconds, oldest.begin(),
                         [](double seconds) { return static_cast<float>(seconds); });
}

void TickBudget::fill(wire::Status& status) const {
  const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(count_, remembered));
  std::vector<float> times(size);
  for (auto phase = static_cast<std::size_t>(timing::Phase::encode); phase < timing::phase_count;
       ++phase) {
    for (std::size_t i = 0; i < size; ++i) times[i] = ticks_[i][phase];
    const bool has_time = std::ranges::any_of(times, [](float time) { return time > 0; });
    if (has_time) status.budget.push_back({timing::phase_names[phase], latency_of(times)});
  }
}

}  // namespace ziggurat::supervision
