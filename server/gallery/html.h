// SPDX-License-Identifier: MIT
#pragma once
// The pages of the gallery. They have no script.

#include <string>
#include <string_view>
#include <vector>

#include "gallery/scenes.h"

namespace ziggurat::gallery {

enum class Picture { awaited, there, missing };

/// A card for each scene. It comes again by itself as long as a picture is awaited.
/// @param pictures  as many as scenes
/// @param path      of the gallery, as `/TOKEN/`
std::string gallery_page(const std::string& folder, const std::vector<Scene>& scenes,
                         const std::vector<Picture>& pictures, const std::string& path);

/// A sentence, and the way back. @param again  it asks once more after a second
std::string notice_page(const std::string& sentence, const std::string& path, bool again);

}  // namespace ziggurat::gallery
