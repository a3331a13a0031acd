// SPDX-License-Identifier: MIT
#include "run/loading.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>

#include "processes/commands.h"
#include "processes/scripts.h"
#include "run/options/controller_option.h"
#include "text/numbers.h"

namespace ziggurat::run {
namespace {

// An entity of the layout as the scene describes it; for a distributed one its pattern. Both are in
// scene order.
const scene::Entity& as_written(const scene::Scene& scene, std::size_t entity) {
  if (entity < scene.entities.size()) return scene.entities[entity];
  entity -= scene.entities.size();
  auto group = scene.distributions.begin();
  for (; entity >= group->quantity; ++group) entity -= group->quantity;
  return group->entity;
}

/// Refuses images that no memory holds: all of a tick's are kept at once.
void check_images(const scene::Scene& scene, const std::string& path,
                  std::vector<scene::Problem>& problems) {
  constexpr double most = 0x1p30;  // [bytes]
  double size = 0;
  std::size_t count = 0;
  const scene::Camera* first = nullptr;
  const auto add = [&](const scene::Entity& entity, std::size_t quantity) {
    if (!entity.controller) return;
    const auto& use = scene.controllers[*entity.controller].devices.cameras;
    for (const scene::Camera& camera : use ? use->cameras : std::vector<scene::Camera>()) {
      if (!camera.image) continue;
      if (!first) first = &camera;
      size += 3.0 * camera.resolution[0] * camera.resolution[1] * static_cast<double>(quantity);
      count += quantity;
    }
  };
  for (const auto& entity : scene.entities) add(entity, 1);
  for (const auto& group : scene.distributions) add(group.entity, group.quantity);
  if (size <= most) return;
  problems.push_back(
      {scene::Problem::Severity::fault, path, first->where,
       fmt::format("{} cameras take images of {:.1f} GiB at every tick; 1 GiB is the "
                   "most; write smaller resolutions, or fewer cameras with image",
                   count, size / most)});
}

}  // namespace

scene::OpenScene load_scene(const std::string& path, const Options& options,
                            reports::Console& console) {
  auto result = scene::read_file(path, options.scene_file);
  auto problems = std::move(result.problems);
  const auto add = [&](const std::vector<scene::Problem>& more) {
    problems.insert(problems.end(), more.begin(), more.end());
  };
  // Commands that are replaced need not exist. A Lua controller remains one for clients that
  // connect: CMD may be ziggurat-lua in a debugger.
  for (const auto& [id, command] : options.controllers) set_command(result.scene, id, {});
  add(processes::find_commands(result.scene, path));
  for (const auto& [id, command] : options.controllers) set_command(result.scene, id, command);
  add(processes::check_scripts(result.scene, path));
  check_images(result.scene, path, problems);
  const auto faults = std::stable_partition(problems.begin(), problems.end(), [](const auto& each) {
    return each.severity != scene::Problem::Severity::fault;
  });
  std::for_each(problems.begin(), faults, [&](const auto& each) { console.problem(each); });
  if (faults != problems.end()) {
    throw scene::SceneError(
        {std::make_move_iterator(faults), std::make_move_iterator(problems.end())});
  }
  return {std::move(result.scene), std::move(result.additions)};
}

std::uint64_t choose_seed(const Options& options, std::uint64_t usual) {
  std::uint64_t seed = options.seed.value_or(usual);
  std::random_device system;
  while (seed == 0) seed = system();
  return seed;
}

std::uint64_t tick_at(double time, const scene::Experiment& experiment) {
  // 0.29 s at 100 ticks/s are 29 ticks, though the product is 28.999999999999996.
  const double ticks = std::floor(time * experiment.ticks_per_second * (1 + 1e-12));
  return ticks < 0x1p63 ? static_cast<std::uint64_t>(ticks) : std::uint64_t{1} << 63;
}

std::optional<std::uint64_t> tick_count(const Options& options, const scene::Scene& scene) {
  if (options.ticks) return options.ticks;
  const double length = options.duration.value_or(scene.experiment.length);
  if (length <= 0) return std::nullopt;
  const std::uint64_t ticks = tick_at(length, scene.experiment);
  if (ticks == 0) {
    throw text::UsageError(fmt::format(
        "the length of {} s is shorter than one tick of 1/{} s; write at least one tick", length,
        scene.experiment.ticks_per_second));
  }
  return ticks;
}

std::vector<std::string> script_paths(const scene::Scene& scene, const world::Layout& layout,
                                      const std::string& scene_path) {
  std::vector<std::string> paths;
  for (const auto& robot : layout.robots) {
    paths.push_back(processes::script_path(scene, as_written(scene, robot.entity), scene_path));
  }
  return paths;
}

}  // namespace ziggurat::run
