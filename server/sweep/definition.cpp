// SPDX-License-Identifier: MIT
#include "sweep/definition.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "text/numbers.h"
#include "text/quoting.h"

namespace ziggurat::sweep {
namespace {

using nlohmann::ordered_json;

constexpr int file_version = 1;

const char* to_text(Axis::Kind kind) {
  return kind == Axis::Kind::parameter ? "parameter" : "setting";
}

std::string to_text(const Axis& axis) {
  return fmt::format("{}={}", axis.name, fmt::join(axis.values, "|"));
}

bool is_same_axis(const Axis& a, const Axis& b) {
  return a.kind == b.kind && a.name == b.name && a.values == b.values;
}

/// The first argument of runs that differs.
std::string differing_argument(const std::vector<std::string>& kept,
                               const std::vector<std::string>& now) {
  const auto [was, is] = std::ranges::mismatch(kept, now);
  if (was == kept.end()) return fmt::format("its runs have no argument '{}'", *is);
  if (is == now.end()) return fmt::format("its runs also have the argument '{}'", *was);
  const auto name = [&](auto at) {  // of the option whose value it is
    return at == kept.begin() || at->starts_with("--") ? "" : *std::prev(at) + " ";
  };
  return fmt::format("its runs have '{0}{1}', not '{0}{2}'", name(was), *was, *is);
}

std::string differing(const Experiment& kept, const Experiment& now) {
  if (kept.scene != now.scene) return fmt::format("its scene is {}", kept.scene);
  for (const Axis& axis : kept.axes) {
    const auto found = std::ranges::find(now.axes, axis.name, &Axis::name);
    if (found == now.axes.end() || found->values != axis.values || found->kind != axis.kind) {
      return fmt::format("it has '{}'", to_text(axis));
    }
  }
  for (const Axis& axis : now.axes) {
    const auto found = std::ranges::find(kept.axes, axis.name, &Axis::name);
    if (found == kept.axes.end()) return fmt::format("it has no '{}'", axis.name);
  }
  if (kept.seeds != now.seeds) {
    return fmt::format("it has {} seeds from {} to {}", kept.seeds.size(), kept.seeds.front(),
                       kept.seeds.back());
  }
  if (kept.run_arguments != now.run_arguments) {
    return differing_argument(kept.run_arguments, now.run_arguments);
  }
  const auto [first, other] = std::ranges::mismatch(kept.axes, now.axes, is_same_axis);
  return fmt::format("its axes have another order: '{}' comes before '{}'", first->name,
                     other->name);
}

bool is_same(const Experiment& a, const Experiment& b) {
  return a.scene == b.scene && a.seeds == b.seeds && a.run_arguments == b.run_arguments &&
         std::ranges::equal(a.axes, b.axes, is_same_axis);
}

}  // namespace

std::string to_json(const Definition& definition) {
  const Experiment& experiment = definition.experiment;
  auto axes = ordered_json::array();
  for (const Axis& axis : experiment.axes) {
    axes.push_back({{"kind", to_text(axis.kind)}, {"name", axis.name}, {"values", axis.values}});
  }
  const ordered_json json{{"format", file_version},
                          {"scene", experiment.scene},
                          {"axes", axes},
                          {"seeds", experiment.seeds},
                          {"run_arguments", experiment.run_arguments},
                          {"files", definition.files}};
  return json.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

Definition definition_from_json(const std::string& text, const std::string& path) {
  try {
    const auto json = nlohmann::json::parse(text);
    if (json.at("format") != file_version) {
      throw text::UsageError(fmt::format("{} was written by another version of ziggurat", path));
    }
    Definition definition;
    Experiment& experiment = definition.experiment;
    json.at("scene").get_to(experiment.scene);
    json.at("seeds").get_to(experiment.seeds);
    json.at("run_arguments").get_to(experiment.run_arguments);
    json.at("files").get_to(definition.files);
    for (const auto& each : json.at("axes")) {
      Axis& axis = experiment.axes.emplace_back();
      axis.kind = each.at("kind") == to_text(Axis::Kind::parameter) ? Axis::Kind::parameter
                                                                    : Axis::Kind::setting;
      each.at("name").get_to(axis.name);
      each.at("values").get_to(axis.values);
    }
    check(experiment);
    if (experiment.seeds.empty()) throw text::UsageError(fmt::format("{} has no seeds", path));
    return definition;
  } catch (const nlohmann::json::exception& error) {
    throw text::UsageError(fmt::format("{} is not as a sweep writes it: {}", path, error.what()));
  }
}

void check_same(const Definition& kept, const Definition& now, const std::string& folder) {
  if (!is_same(kept.experiment, now.experiment)) {
    throw text::UsageError(
        fmt::format("{} has the results of another sweep: {}; write another folder with --out, or "
                    "continue that sweep with: ziggurat sweep resume {}",
                    folder, differing(kept.experiment, now.experiment), text::shell_word(folder)));
  }
  if (kept.files == now.files) return;
  const auto [was, is] = std::ranges::mismatch(kept.files, now.files);
  // The first by path; one that is new or gone has changed, too.
  const bool is_new = was == kept.files.end() || (is != now.files.end() && is->first < was->first);
  const std::string& file = is_new ? is->first : was->first;
  throw text::UsageError(
      fmt::format("{} has changed since the sweep in {} began, so that old and new runs are of "
                  "different worlds; undo the change, or write another folder with --out",
                  file, folder));
}

}  // namespace ziggurat::sweep
