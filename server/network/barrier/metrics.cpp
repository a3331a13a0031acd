// SPDX-License-Identifier: MIT
#include "network/barrier/metrics.h"

#include <fmt/format.h>

#include <set>

#include "wire/messages.h"

namespace ziggurat::network {
namespace {

template <class Values>
std::vector<wire::Metric> list(const Values& values) {
  std::vector<wire::Metric> metrics;
  metrics.reserve(values.size());
  for (const auto& [key, value] : values) metrics.push_back({key.first, key.second, value});
  return metrics;
}

}  // namespace

std::optional<wire::Fault> Metrics::check(const std::vector<wire::Metric>& metrics) const {
  std::map<std::size_t, std::set<std::string>> added;
  for (const wire::Metric& metric : metrics) {
    if (last_.contains({metric.robot, metric.name})) continue;
    auto& names = added[metric.robot];
    names.insert(metric.name);
    const auto known = names_.find(metric.robot);
    const std::size_t before = known == names_.end() ? 0 : known->second;
    if (before + names.size() <= most_names) continue;
    return wire::make_fault(
        wire::ErrorCode::too_many, "metrics",
        fmt::format("A robot or director may have {} metrics; '{}' would be one more.", most_names,
                    metric.name));
  }
  return std::nullopt;
}

void Metrics::set(const std::vector<wire::Metric>& metrics) {
  for (const wire::Metric& metric : metrics) {
    const auto [place, is_new] = last_.insert_or_assign({metric.robot, metric.name}, metric.value);
    if (is_new) ++names_[metric.robot];
    of_tick_.insert_or_assign(place->first, metric.value);
  }
}

void Metrics::clear() {
  last_.clear();
  of_tick_.clear();
  names_.clear();
}

std::vector<wire::Metric> Metrics::of_tick() const { return list(of_tick_); }
std::vector<wire::Metric> Metrics::last() const { return list(last_); }

}  // namespace ziggurat::network
