// SPDX-License-Identifier: MIT
#include "run/start_point.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>
#include <variant>

#include "processes/commands.h"
#include "processes/scripts.h"
#include "processes/spawned_scripts.h"
#include "run/files.h"
#include "run/loading.h"
#include "run/record.h"

namespace ziggurat::run {
namespace {

constexpr double before_placing = 0.1, before_building = 0.4;  // how far the world is loaded then

/// The path of the one scene. A client would connect to a run that cannot start, so that the scene
/// must exist. @throws text::UsageError, scene::SceneError
std::string existing_scene(const Options& options) {
  const std::string& path = only_scene(options);
  check_files(options);
  std::error_code error;
  if (!std::filesystem::exists(path, error))
    throw scene::SceneError(scene::read_file(path, options.scene_file).problems);
  return path;
}

/// Opens as `open` does, and keeps what was read.
scene::OpenFile keep(scene::OpenFile open, std::vector<recorder::EmbeddedFile>& files) {
  return [&files, open = std::move(open)](const std::filesystem::path& path, std::size_t max_size) {
    auto opened = open(path, max_size);
    const auto* file = std::get_if<scene::File>(&opened);
    const auto is_same = [&](const auto& each) { return each.name == path.string(); };
    if (file && std::ranges::none_of(files, is_same)) files.push_back({path.string(), file->text});
    return opened;
  };
}

/// Directors of the scene, with the paths of their scripts.
std::vector<scene::Director> directors_of(const supervision::World& world) {
  std::vector<scene::Director> directors = world.scene.directors;
  for (scene::Director& director : directors) {
    director.script = processes::script_path(world.scene, director, world.path);
  }
  return directors;
}

}  // namespace

simulation::TellStep tell_steps(const TellLoading& tell) {
  return [&tell](simulation::Step step, std::size_t done, std::size_t all) {
    const bool is_placing = step == simulation::Step::placing;
    const double from = is_placing ? before_placing : before_building,
                 to = is_placing ? before_building : 1;
    tell(from + (to - from) * static_cast<double>(done) / static_cast<double>(all),
         fmt::format("{} of {} entities are {}.", done, all, is_placing ? "placed" : "built"));
  };
}

SceneStart::SceneStart(const Options& options)
    : options_(options), path_(existing_scene(options)) {}

std::unique_ptr<supervision::World> SceneStart::build(const TellLoading& tell,
                                                      reports::Console& console) {
  tell(0, "The scene is being read.");
  Options options = options_;
  if (!options.record.empty())
    options.scene_file.open = keep(std::move(options.scene_file.open), files_);
  scene::OpenScene opened = load_scene(path_, options, console);
  std::vector<std::string> read;
  for (const auto& file : files_) read.push_back(file.name);
  check_outputs(options, opened.scene, read);
  tell(before_placing, "The world is being built.");
  const std::uint64_t seed = choose_seed(options, usual_seed(opened.scene));
  return std::make_unique<supervision::World>(path_, std::move(opened), seed, tell_steps(tell));
}

std::uint64_t SceneStart::usual_seed(const scene::Scene& scene) const {
  return scene.experiment.random_seed;
}

std::optional<std::uint64_t> SceneStart::last_tick(const scene::Scene& scene) const {
  return options_.pictures ? run::last_tick(*options_.pictures, scene.experiment)
                           : tick_count(options_, scene);
}

Programs SceneStart::programs(const supervision::World& world, const std::string&,
                              bool with_controllers) const {
  Programs programs;
  programs.scripts = script_paths(world.scene, world.simulation.layout(), path_);
  if (with_controllers) programs.directors = directors_of(world);
  programs.folder = processes::scene_folder(path_);
  for (const auto& folder : processes::folders_of(world.scene, path_))
    programs.script_folders.push_back(folder.string());
  programs.fixed_files = files_of(world.scene, path_);
  return programs;
}

void SceneStart::describe(const supervision::World& world, recorder::Start& start,
                          reports::Console& console) const {
  start.files = files_;
  add_scripts(world, start, console);
}

}  // namespace ziggurat::run
