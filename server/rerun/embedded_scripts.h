// SPDX-License-Identifier: MIT
#pragma once
// The Lua scripts of a recording, as files that ziggurat-lua can run.

#include <string>
#include <vector>

#include "recording/replay/embedded_files.h"
#include "scene/scene.h"
#include "world/layout.h"

namespace ziggurat::rerun {

/// Writes all embedded files below a folder, which nothing in their names can leave.
void write_below(const std::string& folder, const replay::EmbeddedFiles& files);

/// The script of a robot below that folder; empty if its controller runs none.
/// @throws replay::RecordingError if it is not embedded
std::string script_below(const std::string& folder, const replay::EmbeddedFiles& files,
                         const scene::Scene& scene, const std::string& scene_path,
                         const world::RobotLayout& robot);
/// The same of a director.
std::string script_below(const std::string& folder, const replay::EmbeddedFiles& files,
                         const scene::Scene& scene, const std::string& scene_path,
                         const scene::Director& director);

}  // namespace ziggurat::rerun
