// SPDX-License-Identifier: MIT
#include "sweep/columns.h"

#include <fmt/format.h>

#include <iterator>
#include <optional>
#include <set>

#include "text/quoting.h"

namespace ziggurat::sweep {
namespace {

template <class T>
std::string or_empty(const std::optional<T>& value) {
  return value ? fmt::format("{}", *value) : std::string();
}

/// Parallel to result_columns.
std::vector<std::string> fields_of(const Result& result) {
  return {fmt::format("{}", result.seed),
          to_text(result.outcome),
          fmt::format("{}", result.exit_code),
          text::csv_field(result.ending),
          or_empty(result.ticks),
          or_empty(result.simulated_s),
          or_empty(result.robots),
          or_empty(result.failures),
          or_empty(result.dropped),
          or_empty(result.not_converged),
          or_empty(result.worst_residual),
          result.hash};
}

/// A to Z only.
std::string in_lower_case(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

std::string line(const std::vector<std::string>& fields) {
  return fmt::format("{}\n", fmt::join(fields, ","));
}

}  // namespace

Columns columns_of(const Experiment& experiment, std::span<const Result> results) {
  std::set<std::string> taken = {"run"};
  taken.insert(result_columns.begin(), result_columns.end());
  taken.insert(last_columns.begin(), last_columns.end());
  const auto take = [&](std::string name, const char* prefix) {
    while (!taken.insert(in_lower_case(name)).second) name = prefix + name;
    return name;
  };
  Columns columns;
  for (const Axis& axis : experiment.axes) columns.axes.push_back(take(axis.name, "param_"));
  for (const std::string& name : metric_names(results))
    columns.metrics[name] = take(name, "metric_");
  return columns;
}

std::string to_csv(const Experiment& experiment, std::span<const Result> results) {
  const Columns columns = columns_of(experiment, results);
  std::vector<std::string> fields = {"run"};
  for (const auto& name : columns.axes) fields.push_back(text::csv_field(name));
  fields.insert(fields.end(), result_columns.begin(), result_columns.end());
  for (const auto& [metric, name] : columns.metrics) fields.push_back(text::csv_field(name));
  fields.insert(fields.end(), last_columns.begin(), last_columns.end());
  std::string text = line(fields);
  for (const Result& result : results) {
    fields = {fmt::format("{}", result.run)};
    for (const auto& value : combination(experiment, result.run).values) {
      fields.push_back(text::csv_field(value));
    }
    auto known = fields_of(result);
    fields.insert(fields.end(), std::move_iterator(known.begin()), std::move_iterator(known.end()));
    for (const auto& [metric, name] : columns.metrics) {
      const auto found = result.metrics.find(metric);
      fields.push_back(found == result.metrics.end() ? "" : fmt::format("{}", found->second));
    }
    fields.push_back(fmt::format("{:.3f}", result.wall_s));
    fields.push_back(text::csv_field(result.version));
    text += line(fields);
  }
  return text;
}

}  // namespace ziggurat::sweep
