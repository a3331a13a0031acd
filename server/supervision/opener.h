#pragma once
// Files that spawned elements may name.

#include <string>

#include "processes/spawned_scripts.h"
#include "scene/files.h"
#include "supervision/world_change.h"

namespace ziggurat::supervision {

/// Opens files below the allowed folders: as an element of the scene file would name them,
/// otherwise relative to one of these folders.
/// @param allowed  must outlive what is returned
/// @param spawned  gets the files, and must outlive it, too; may be null
scene::OpenFile opener(const processes::AllowedFiles& allowed, const std::string& scene_file,
                       Spawned* spawned = nullptr);

}  // namespace ziggurat::supervision
