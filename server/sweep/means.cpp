// SPDX-License-Identifier: MIT
#include "sweep/means.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "scene/values.h"
#include "text/names.h"
#include "text/numbers.h"

namespace ziggurat::sweep {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

template <class T>
double or_nothing(const std::optional<T>& value) {
  return value ? static_cast<double>(*value) : nothing;
}

/// The numbers of every run that are no metrics.
const std::map<std::string, double (*)(const Result&)>& own_measures() {
  static const std::map<std::string, double (*)(const Result&)> measures = {
      {"ticks", [](const Result& result) { return or_nothing(result.ticks); }},
      {"simulated_s", [](const Result& result) { return or_nothing(result.simulated_s); }},
      {"wall_s", [](const Result& result) { return result.wall_s; }},
      {"robots", [](const Result& result) { return or_nothing(result.robots); }},
      {"failures", [](const Result& result) { return or_nothing(result.failures); }},
      {"dropped", [](const Result& result) { return or_nothing(result.dropped); }},
      {"solver_not_converged",
       [](const Result& result) { return or_nothing(result.not_converged); }},
      {"solver_worst_residual",
       [](const Result& result) { return or_nothing(result.worst_residual); }},
  };
  return measures;
}

/// `iterations` of `physics_engines/dynamics3d/@iterations`.
std::string short_name(const Axis& axis) {
  const std::size_t at = axis.name.rfind('@');
  return axis.kind == Axis::Kind::setting && at != axis.name.npos ? axis.name.substr(at + 1)
                                                                  : axis.name;
}

}  // namespace

Estimate estimate(std::span<const double> values, double confidence) {
  Estimate result;
  result.count = values.size();
  if (values.empty()) return result;
  const auto n = static_cast<double>(values.size());
  result.mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  if (values.size() < 2) return result;
  double squares = 0;
  for (const double value : values) squares += (value - result.mean) * (value - result.mean);
  const double deviation = std::sqrt(squares / (n - 1));
  // In double precision: Valgrind has no long double, and Boost's tables would not initialise under
  // it.
  using namespace boost::math::policies;
  const boost::math::students_t_distribution<double, policy<promote_double<false>>> distribution(n -
                                                                                                 1);
  const double t = boost::math::quantile(distribution, 0.5 + confidence / 2);
  result.half_width = t * deviation / std::sqrt(n);
  return result;
}

std::vector<Group> group(const Experiment& experiment, std::span<const Result> results,
                         std::span<const std::size_t> axes, std::span<const std::string> measures,
                         double confidence) {
  std::vector<Group> groups;
  std::vector<std::vector<std::vector<double>>> values;  // by group and measure
  std::map<std::vector<std::string>, std::size_t> place_of;
  for (const Result& result : results) {
    const Combination run = combination(experiment, result.run);
    std::vector<std::string> key;
    for (const std::size_t axis : axes) key.push_back(run.values[axis]);
    const auto [place, is_new] = place_of.emplace(key, groups.size());
    if (is_new) {
      groups.emplace_back().values = key;
      values.emplace_back(measures.size());
    }
    const std::size_t index = place->second;
    if (result.outcome != Outcome::finished) {
      ++groups[index].failed;
      continue;
    }
    ++groups[index].finished;
    for (std::size_t i = 0; i < measures.size(); ++i) {
      const double value = value_of(result, measures[i]);
      if (std::isfinite(value)) values[index][i].push_back(value);
    }
  }
  for (std::size_t i = 0; i < groups.size(); ++i) {
    for (const auto& each : values[i]) groups[i].estimates.push_back(estimate(each, confidence));
  }
  return groups;
}

std::vector<std::string> measures_of(std::span<const Result> results) {
  const std::set<std::string> metrics = metric_names(results);
  std::vector<std::string> names(metrics.begin(), metrics.end());
  for (const auto& [name, read] : own_measures()) {
    if (!metrics.contains(name)) names.push_back(name);
  }
  return names;
}

double value_of(const Result& result, const std::string& measure) {
  if (const auto found = result.metrics.find(measure); found != result.metrics.end()) {
    return found->second;
  }
  const auto own = own_measures().find(measure);
  return own == own_measures().end() ? nothing : own->second(result);
}

std::size_t axis_named(const Experiment& experiment, const std::string& name) {
  std::vector<std::string> known;
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < experiment.axes.size(); ++i) {
    const Axis& axis = experiment.axes[i];
    if (axis.name == name) return i;
    if (short_name(axis) == name) found.push_back(i);
    known.push_back(short_name(axis));
  }
  if (found.size() == 1) return found.front();
  if (found.size() > 1) {
    throw text::UsageError(fmt::format("{} may mean {} or {}; write one of them",
                                       scene::in_quotes(name),
                                       scene::in_quotes(experiment.axes[found[0]].name),
                                       scene::in_quotes(experiment.axes[found[1]].name)));
  }
  throw text::UsageError(fmt::format(
      "the sweep has no axis {}; {}", scene::in_quotes(name),
      text::advice(name, known,
                   known.empty() ? std::string("it has none")
                                 : fmt::format("known here: {}", fmt::join(known, ", ")))));
}

}  // namespace ziggurat::sweep
