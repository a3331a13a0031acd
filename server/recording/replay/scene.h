// SPDX-License-Identifier: MIT
#pragma once
// The scene of a recording.

#include <string>

#include "recording/replay/embedded_files.h"
#include "recording/replay/recording_file.h"
#include "scene/additions.h"
#include "simulation/snapshot.h"

namespace ziggurat::v1 {
class RunStart;
}

namespace ziggurat::replay {

/// Reads the scene from the embedded files, with the options of the run.
/// @param more  set after what the run set
/// @throws RecordingError if the run or its files are not as they were recorded
/// @throws scene::SceneError with the faults that this program finds in the scene
scene::OpenScene read_scene(const v1::RunStart& run, const EmbeddedFiles& files,
                            const scene::Variation& more = {});

/// @throws RecordingError if the run was computed by a core of physics that this version does not
/// have
void check_core(const v1::RunStart& run, const scene::Scene& scene);

/// Hash of the embedded files and their settings: 16 hexadecimal digits.
std::string scene_hash(const scene::Scene& scene, const EmbeddedFiles& files);

/// Reads a snapshot that the recording has; its state is compared with its hash when it is
/// restored.
/// @throws RecordingError if it has none of this name; simulation::SnapshotError, scene::SceneError
simulation::Snapshot read_snapshot(const RecordingFile& file, const std::string& name,
                                   const scene::Scene& scene, const scene::Additions& additions);

}  // namespace ziggurat::replay
