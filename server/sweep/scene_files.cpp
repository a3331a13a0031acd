// SPDX-License-Identifier: MIT
#include "sweep/scene_files.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <set>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "math/hash.h"
#include "processes/required_scripts.h"
#include "processes/scripts.h"
#include "scene/reader.h"
#include "sweep/folder.h"

namespace ziggurat::sweep {
namespace {

namespace fs = std::filesystem;

std::string hash_of(std::string_view bytes) {
  math::Hash hash;
  hash.add(bytes);
  return math::to_hex(hash.digest());
}

/// The scene's values where an axis has fewer values than another are its last ones.
scene::Variation variation(const Experiment& experiment, std::size_t index) {
  scene::Variation variation;
  for (const Axis& axis : experiment.axes) {
    const std::string& value = axis.values[std::min(index, axis.values.size() - 1)];
    if (axis.kind == Axis::Kind::parameter) {
      variation.parameters.emplace_back(axis.name, value);
    } else {
      variation.settings.push_back({axis.name, value});
    }
  }
  return variation;
}

/// Messages of the reader about `--set` name `--axis` here.
void name_option(std::vector<scene::Problem>& problems) {
  for (scene::Problem& problem : problems) {
    for (std::size_t at = 0; (at = problem.text.find("--set '", at)) != std::string::npos;) {
      problem.text.replace(at, 5, "--axis");
    }
  }
}

/// Throws if there are faults. Otherwise keeps each warning once.
void take_problems(std::vector<scene::Problem> problems, std::vector<scene::Problem>& warnings) {
  name_option(problems);
  const auto rest = std::stable_partition(problems.begin(), problems.end(), [](const auto& each) {
    return each.severity == scene::Problem::Severity::fault;
  });
  if (rest != problems.begin()) {
    throw scene::SceneError({problems.begin(), rest});
  }
  for (scene::Problem& each : problems) {
    const bool is_known = std::ranges::any_of(warnings, [&](const auto& known) {
      return scene::to_string(known) == scene::to_string(each);
    });
    if (each.severity == scene::Problem::Severity::warning && !is_known)
      warnings.push_back(std::move(each));
  }
}

}  // namespace

SceneFiles read_scene(const Experiment& experiment) {
  SceneFiles files;
  const auto keep = [&](const fs::path& path, std::size_t max_size) {
    auto opened = scene::open_file(path, max_size);
    if (const auto* file = std::get_if<scene::File>(&opened)) {
      files.hashes[fs::absolute(path).lexically_normal().string()] = hash_of(file->text);
    }
    return opened;
  };
  std::size_t most_values = 1;
  for (const Axis& axis : experiment.axes) most_values = std::max(most_values, axis.values.size());
  std::vector<fs::path> scripts;
  for (std::size_t i = 0; i < most_values; ++i) {
    scene::ReadOptions options;
    options.lenient =
        std::ranges::find(experiment.run_arguments, "--lenient") != experiment.run_arguments.end();
    options.variation = variation(experiment, i);
    options.open = keep;
    auto scene = scene::read_file(experiment.scene, options);
    if (scene.ok()) {
      auto more = processes::check_scripts(scene.scene, experiment.scene);
      std::ranges::move(more, std::back_inserter(scene.problems));
    }
    take_problems(std::move(scene.problems), files.warnings);
    files.seed = scene.scene.experiment.random_seed;
    const double length = scene.scene.experiment.length;
    files.length = i == 0 ? length : std::min(files.length, length);
    std::ranges::move(processes::scripts_of(scene.scene, experiment.scene),
                      std::back_inserter(scripts));
  }
  processes::add_required(scripts);
  for (const fs::path& script : scripts) files.hashes[script.string()] = hash_of(read_file(script));
  return files;
}

}  // namespace ziggurat::sweep
