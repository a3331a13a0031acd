// SPDX-License-Identifier: MIT
// <framework>: time, and what belongs to a process and has no effect on a server.

#include <algorithm>
#include <cmath>

#include "scene/draft.h"

namespace ziggurat::scene {
namespace {

constexpr double most_ticks = 9007199254740992.0;  // 2^53: counted exactly in every double
constexpr unsigned most_per_second = 1'000'000;
constexpr double longest = 9e9;  // [s]: nanoseconds fit 64 bits

void read_experiment(Element experiment, Experiment& out) {
  out.ticks_per_second = experiment.required("ticks_per_second", Whole{1, most_per_second}, 1);
  out.length = experiment.optional("length", In{"s", non_negative}, 0.0);
  out.random_seed = experiment.optional("random_seed", seed, 0);
  out.real_time = experiment.optional("real_time", boolean, false);
  if (out.length > longest || out.length * out.ticks_per_second > most_ticks) {
    experiment.fault_at("length",
                        "is too long; write at most 9e9 s and 2^53 ticks, or 0 for no end");
  } else if (const double ticks = out.length * out.ticks_per_second, whole = std::round(ticks);
             std::abs(ticks - whole) > 1e-9 * std::max(1.0, ticks)) {
    experiment.report().notice(
        experiment.where("length"),
        experiment.sentence(
            "length",
            fmt::format("is {:.9g} ticks of 1/{} s: the run has {:.0f}, and ends after {:.9g} s",
                        ticks, out.ticks_per_second, std::floor(ticks),
                        std::floor(ticks) / out.ticks_per_second)));
  }
  experiment.done();
}

/// A reader of the value of an option of the run.
auto value_of_option(const RunAttributes& known, const std::string& name) {
  return [&known, &name](std::string_view text) -> Value<std::string> {
    std::string value(text);
    auto wrong = known.wrong ? known.wrong(name, value) : std::nullopt;
    if (wrong) return Wrong{std::move(*wrong)};
    return value;
  };
}

void read_run(Element run, const RunAttributes& known, Scene& scene) {
  if (!known.wrong) scene.run = run.all_attributes();
  for (const std::string& name : known.names) {
    auto value = run.optional(name.c_str(), value_of_option(known, name));
    if (value) scene.run.emplace_back(name, std::move(*value));
  }
  run.done();
}

/// The dialect's place for an option of the run: threads, of which 0 are none beside the main one.
void read_threads(Element& system, const RunAttributes& known, Scene& scene) {
  const std::string name = "threads";
  if (written(system, "threads") == "0") return void(system.optional("threads", count));
  auto value = system.optional("threads", value_of_option(known, name));
  const bool is_given = std::ranges::any_of(scene.run, [&](auto& o) { return o.first == name; });
  if (value && !is_given) scene.run.emplace_back(name, std::move(*value));
}

void read_system(Element system, const RunAttributes& known, Scene& scene) {
  read_threads(system, known, scene);
  constexpr std::string_view why = "results never depend on threads";
  system.without_effect("method", Words{"balance_quantity", "balance_length"}, why);
  system.without_effect("pin_threads_to_cores", boolean, why);
  system.done();
}

void read_profiling(Element profiling) {
  profiling.report().notice(profiling.where(),
                            "<profiling> has no effect here: the run's summary holds the times");
  profiling.required("file", path);
  profiling.required("format", Words{"human_readable", "table"});
  profiling.optional("truncate_file", boolean);
  profiling.done();
}

}  // namespace

void read_framework(Draft& draft, Element& root) {
  auto framework = root.required_child("framework");
  if (!framework) return;
  if (auto experiment = framework->required_child("experiment")) {
    read_experiment(*experiment, draft.scene.experiment);
  }
  if (auto run = framework->child("run")) read_run(*run, draft.options.run, draft.scene);
  if (auto system = framework->child("system"))
    read_system(*system, draft.options.run, draft.scene);
  if (auto profiling = framework->child("profiling")) read_profiling(*profiling);
  framework->done();
}

}  // namespace ziggurat::scene
