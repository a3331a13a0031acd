// SPDX-License-Identifier: MIT
#include "sweep/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <vector>

#include "reports/plot.h"
#include "sweep/means.h"
#include "text/numbers.h"
#include "text/printable.h"
#include "text/shortened.h"

namespace ziggurat::sweep {
namespace {

/// Colors that people with color blindness tell apart (Okabe and Ito 2008), without the yellow.
constexpr std::array colors = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                               "#e69f00", "#56b4e9", "#000000"};

bool is_number(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return end != text.c_str() && *end == '\0' && std::isfinite(value);
}

/// The means at the axis' values, in the order of the panel, and their intervals.
reports::Curve curve_of(const std::vector<Group>& groups, const std::vector<std::string>& values) {
  reports::Curve curve;
  for (const std::string& value : values) {
    const auto found =
        std::ranges::find(groups, value, [](const Group& each) { return each.values[0]; });
    const Estimate estimate = found == groups.end() ? Estimate{} : found->estimates[0];
    curve.y.push_back(estimate.mean);
    curve.spread.push_back(estimate.count > 1 ? estimate.half_width : 0);
  }
  return curve;
}

}  // namespace

std::string to_svg(const Experiment& experiment, std::span<const Result> results,
                   const Plot& plot) {
  const Axis& x = experiment.axes[plot.x];
  reports::Panel panel;
  panel.scale = reports::Scale::linear;
  panel.x_label = x.name;
  panel.y_label = fmt::format("{} (mean, {:g} % confidence)", plot.measure, 100 * plot.confidence);
  std::vector<std::string> values = x.values;
  const auto number = [](const std::string& text) { return std::strtod(text.c_str(), nullptr); };
  if (std::ranges::all_of(values, is_number)) {
    std::ranges::stable_sort(values, {}, number);
    std::ranges::transform(values, std::back_inserter(panel.x), number);
  } else {
    panel.x_names = values;
    for (const auto& value : values) panel.x.push_back(static_cast<double>(&value - values.data()));
  }
  std::vector<std::string> names = {""};
  if (plot.series) names = experiment.axes[*plot.series].values;
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::vector<Result> of_curve;
    std::ranges::copy_if(results, std::back_inserter(of_curve), [&](const Result& result) {
      return !plot.series || combination(experiment, result.run).values[*plot.series] == names[i];
    });
    reports::Curve curve = curve_of(group(experiment, of_curve, std::vector{plot.x},
                                          std::vector{plot.measure}, plot.confidence),
                                    values);
    if (plot.series) curve.name = experiment.axes[*plot.series].name + " = " + names[i];
    curve.color = colors[i % colors.size()];
    curve.dashed = i / colors.size() % 2 == 1;
    panel.curves.push_back(std::move(curve));
  }
  const auto is_empty = [](const reports::Curve& curve) {
    return std::ranges::none_of(curve.y, [](double y) { return std::isfinite(y); });
  };
  if (std::ranges::all_of(panel.curves, is_empty)) {
    throw text::UsageError(fmt::format("no run that finished has a value of {}", plot.measure));
  }
  return reports::to_svg("", {panel});
}

}  // namespace ziggurat::sweep
