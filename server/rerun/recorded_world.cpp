// SPDX-License-Identifier: MIT
#include "rerun/recorded_world.h"

#include <fmt/format.h>

#include <algorithm>

#include "recording/mcap/source.h"
#include "recording/replay/recording_file.h"
#include "recording/replay/scene.h"
#include "run/options/controller_option.h"
#include "text/numbers.h"

namespace ziggurat::rerun {

supervision::World build_recorded(const replay::RecordingFile& file,
                                  const std::function<void(scene::Scene&)>& change) {
  const v1::RunStart& run = file.run();
  scene::OpenScene opened = replay::read_scene(run, file.files());
  if (change) change(opened.scene);
  return {run.scene(), std::move(opened), run.seed(), {}, run.scene_hash()};
}

void set_commands(scene::Scene& scene, const v1::RunStart& run, const Commands& commands) {
  const auto& recorded = run.controllers();
  for (scene::Controller& controller : scene.controllers) {
    const auto found =
        std::ranges::find(recorded, controller.id, [](const auto& each) { return each.id(); });
    const bool is_trusted = commands.trusts_recorded && found != recorded.end();
    controller.command = is_trusted ? found->command() : std::string();
  }
  for (scene::Director& director : scene.directors) {
    if (!commands.trusts_recorded) director.command.clear();
  }
  for (const auto& [id, command] : commands.own) run::set_command(scene, id, command);
}

void begin_as_recorded(const replay::RecordingFile& file, supervision::World& world) {
  replay::check_core(file.run(), world.scene);
  const std::string& name = file.run().snapshot();
  if (name.empty()) return;
  try {
    world.restore(replay::read_snapshot(file, name, world.scene, world.additions));
  } catch (const simulation::SnapshotError& error) {
    throw replay::RecordingError(
        fmt::format("{}: the state that it begins with: {}", file.path(), error.what()));
  }
}

replay::Replay::OpenSnapshot embedded_snapshots(const replay::RecordingFile& file,
                                                const supervision::World& world) {
  return [&file, &world](const std::string& name) {
    return replay::read_snapshot(file, name, world.scene, world.additions);
  };
}

void check_until(const replay::RecordingFile& file, std::uint64_t until) {
  std::uint64_t least = 0, greatest = 0;
  try {
    replay::States states(file);
    const v1::Inputs* next = states.next();
    if (next == nullptr) return;
    for (least = greatest = next->tick(); next != nullptr; next = states.next()) {
      if (next->tick() == until) return;
      least = std::min<std::uint64_t>(least, next->tick());
      greatest = std::max<std::uint64_t>(greatest, next->tick());
    }
  } catch (const replay::RecordingError&) {
    return;
  } catch (const mcap::Damaged&) {
    return;
  }
  throw text::UsageError(fmt::format(
      "--until is {}, and {} has the ticks {} to {}; write one of them, or leave it out", until,
      file.path(), least, greatest));
}

}  // namespace ziggurat::rerun
