// SPDX-License-Identifier: MIT
// A plot of bench/run, by the plotter of `ziggurat sweep`.
//
// usage: bench_plot < plot.json > plot.svg
//
// The input: {"title", "x_label", "y_label", "x": [...], "curves": [{"name", "y": [...], "spread":
// [...]}]}, with null where there is no value.

#include "reports/plot.h"

#include <array>
#include <cmath>
#include <exception>
#include <iostream>
#include <nlohmann/json.hpp>

namespace {

using nlohmann::json;
using namespace ziggurat;

/// Colors that people with color blindness tell apart (Okabe and Ito 2008), without the yellow.
constexpr std::array colors = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"};

std::vector<double> numbers(const json& from) {
  std::vector<double> to;
  for (const json& each : from) to.push_back(each.is_null() ? NAN : each.get<double>());
  return to;
}

reports::Panel panel_of(const json& from) {
  reports::Panel panel;
  panel.x_label = from.at("x_label");
  panel.y_label = from.at("y_label");
  panel.x = numbers(from.at("x"));
  for (const json& each : from.at("curves")) {
    reports::Curve curve;
    curve.name = each.at("name");
    curve.color = colors[panel.curves.size() % colors.size()];
    curve.y = numbers(each.at("y"));
    curve.spread = numbers(each.at("spread"));
    panel.curves.push_back(curve);
  }
  return panel;
}

}  // namespace

int main() try {
  const json plot = json::parse(std::cin);
  std::cout << reports::to_svg(plot.at("title"), {panel_of(plot)});
  return 0;
} catch (const std::exception& error) {
  std::cerr << "bench_plot: " << error.what() << '\n';
  return 1;
}
