#pragma once
// The scene of a recording.

#include "replay/embedded_files.h"
#include "scene/additions.h"

namespace ziggurat::v1 {
class RunStart;
}

namespace ziggurat::replay {

/// Reads the scene from the embedded files, with the options of the run.
/// @throws RecordingError if the run or its files are not as they were recorded
/// @throws scene::SceneError with the faults that this program finds in the scene
scene::OpenScene read_scene(const v1::RunStart& run, const EmbeddedFiles& files);

}  // namespace ziggurat::replay
