#include "network/latencies.h"

#include <algorithm>
#include <cmath>

namespace ziggurat::network {
namespace {

std::size_t bin_of(double seconds) {
  if (!(seconds > Latencies::least)) return 0;
  const double bin = std::log10(seconds / Latencies::least) * 20;
  return std::min(static_cast<std::size_t>(bin), Latencies::bins - 1);
}

/// The share of the values, sorted up to there, that are not above the result.
double nth(std::vector<float>& values, double share) {
  const double place = std::ceil(share * static_cast<double>(values.size())) - 1;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(std::max(place, 0.0));
  std::nth_element(values.begin(), middle, values.end());
  return static_cast<double>(*middle);
}

}  // namespace

void Latencies::add(double seconds, std::uint64_t tick) {
  recent_[count_ % remembered] = static_cast<float>(seconds);
  ++count_;
  ++histogram_[bin_of(seconds)];
  Worst fresh{seconds, tick};
  for (Worst& place : worst_) {
    if (fresh.seconds > place.seconds) std::swap(fresh, place);
  }
}

wire::Latency Latencies::recent() const {
  if (count_ == 0) return {};
  const auto size = static_cast<std::ptrdiff_t>(std::min<std::uint64_t>(count_, remembered));
  std::vector<float> values(recent_.begin(), recent_.begin() + size);
  const double p50 = nth(values, 0.5);
  const double p99 = nth(values, 0.99);
  return {p50, p99, static_cast<double>(*std::ranges::max_element(values))};
}

double Latencies::percentile(double share) const {
  const auto due = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count_)));
  std::uint64_t seen = 0;
  for (std::size_t bin = 0; bin < bins; ++bin) {
    seen += histogram_[bin];
    if (seen >= due && seen > 0) {
      return bin + 1 == bins ? max() : std::min(begin_of(bin + 1), max());
    }
  }
  return 0;
}

double Latencies::begin_of(std::size_t bin) {
  return least * std::pow(10.0, static_cast<double>(bin) / 20);
}

std::vector<Latencies::Worst> Latencies::worst() const {
  std::vector<Worst> result;
  for (const Worst& place : worst_) {
    if (place.seconds > 0) result.push_back(place);
  }
  return result;
}

}  // namespace ziggurat::network
