// SPDX-License-Identifier: MIT
#pragma once
// A recording as a world that is run again: its begin, its snapshots, its ticks.

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "recording/replay/recording_file.h"
#include "recording/replay/replay.h"
#include "supervision/world.h"

namespace ziggurat::rerun {

/// A world of the recording's scene and seed, at tick 0.
/// @param change  of the scene before the world is built
/// @throws replay::RecordingError, scene::SceneError
supervision::World build_recorded(const replay::RecordingFile& file,
                                  const std::function<void(scene::Scene&)>& change = {});

/// No command of a recording is started by itself.
struct Commands {
  bool trusts_recorded = false;  ///< those of the recording stay
  std::vector<std::pair<std::string, std::string>>
      own;  ///< id of a controller or director, command
};
/// @throws text::UsageError as run::set_command()
void set_commands(scene::Scene& scene, const v1::RunStart& run, const Commands& commands);

/// Puts a new world of the recording's scene and seed where the recording begins: into a snapshot,
/// if it is one of a fork. @throws replay::RecordingError, simulation::SnapshotError
void begin_as_recorded(const replay::RecordingFile& file, supervision::World& world);

/// Reads the snapshots that the recording has embedded. Both must outlive it.
replay::Replay::OpenSnapshot embedded_snapshots(const replay::RecordingFile& file,
                                                const supervision::World& world);

/// Checks --until of commands that repeat a recording, and reads it as far as that tick. One that
/// is damaged before it is told later.
/// @throws text::UsageError if it has no state with this tick
void check_until(const replay::RecordingFile& file, std::uint64_t until);

}  // namespace ziggurat::rerun
