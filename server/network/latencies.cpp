// SPDX-License-Identifier: MIT
#include "network/latencies.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace ziggurat::network {
namespace {

/// The smallest value that at least this share of all is not above.
double nth(std::span<const float> ascending, double share) {
  const double place = std::ceil(share * static_cast<double>(ascending.size())) - 1;
  return static_cast<double>(ascending[static_cast<std::size_t>(std::max(place, 0.0))]);
}

/// Puts a value in place of another, and those between one place on.
void replace(std::span<float> ascending, float old, float fresh) {
  const auto from = std::ranges::lower_bound(ascending, old);
  const auto to = std::ranges::lower_bound(ascending, fresh);
  if (from < to) {
    *std::move(from + 1, to, from) = fresh;
  } else {
    std::move_backward(to, from, from + 1);
    *to = fresh;
  }
}

}  // namespace

void Latencies::add(double seconds) {
  const auto value = static_cast<float>(seconds);
  float& oldest = recent_[count_ % remembered];
  const bool is_full = count_ >= remembered;
  const std::size_t size = is_full ? remembered : static_cast<std::size_t>(count_) + 1;
  // Until it is full, the place behind the others is the one that is replaced.
  if (!is_full) sorted_[size - 1] = std::numeric_limits<float>::infinity();
  replace({sorted_.data(), size}, is_full ? oldest : sorted_[size - 1], value);
  oldest = value;
  ++count_;
}

wire::Latency Latencies::recent() const {
  if (count_ == 0) return {};
  const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(count_, remembered));
  const std::span<const float> ascending(sorted_.data(), size);
  return {nth(ascending, 0.5), nth(ascending, 0.99), static_cast<double>(ascending.back())};
}

}  // namespace ziggurat::network
