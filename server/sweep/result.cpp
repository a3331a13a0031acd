// SPDX-License-Identifier: MIT
#include "sweep/result.h"

#include <fstream>
#include <nlohmann/json.hpp>

namespace ziggurat::sweep {
namespace {

using nlohmann::json;

/// Nothing if it is not there or has another type.
template <class T>
std::optional<T> value_at(const json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end() || !found->is_number()) return std::nullopt;
  return found->get<T>();
}

std::string text_at(const json& object, const char* name) {
  const auto found = object.find(name);
  return found == object.end() || !found->is_string() ? std::string() : found->get<std::string>();
}

std::optional<std::uint64_t> count_at(const json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end() || !found->is_array()) return std::nullopt;
  return found->size();
}

}  // namespace

const char* to_text(Outcome outcome) {
  switch (outcome) {
    case Outcome::finished:
      return "finished";
    case Outcome::failed:
      return "failed";
    case Outcome::timed_out:
      return "timed_out";
  }
  return "";
}

std::optional<Outcome> to_outcome(const std::string& text) {
  for (const Outcome each : {Outcome::finished, Outcome::failed, Outcome::timed_out}) {
    if (text == to_text(each)) return each;
  }
  return std::nullopt;
}

std::set<std::string> metric_names(std::span<const Result> results) {
  std::set<std::string> names;
  for (const Result& result : results) {
    for (const auto& [name, value] : result.metrics) names.insert(name);
  }
  return names;
}

bool read_summary(const std::string& path, Result& result) {
  std::ifstream file(path);
  const json summary = json::parse(file, nullptr, false);
  if (!summary.is_object()) return false;
  result.ending = text_at(summary, "ending");
  result.ticks = value_at<std::uint64_t>(summary, "ticks");
  result.simulated_s = value_at<double>(summary, "simulated_s");
  result.hash = text_at(summary, "hash");
  result.robots = value_at<std::uint64_t>(summary, "robots");
  result.failures = count_at(summary, "failures");
  result.dropped = count_at(summary, "dropped");
  if (const auto solver = summary.find("solver"); solver != summary.end() && solver->is_object()) {
    result.not_converged = value_at<std::uint64_t>(*solver, "not_converged");
    result.worst_residual = value_at<double>(*solver, "worst_residual");
  }
  if (const auto metrics = summary.find("metrics");
      metrics != summary.end() && metrics->is_object()) {
    for (const auto& [name, value] : metrics->items()) {
      if (value.is_number()) result.metrics[name] = value.get<double>();
    }
  }
  return true;
}

}  // namespace ziggurat::sweep
