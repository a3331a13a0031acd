// SPDX-License-Identifier: MIT
#pragma once
// Colors in scripts.

#include <optional>
#include <string_view>

#include "ziggurat/actuators.h"

namespace ziggurat::lua {

/// A name of the scene format ("red", "gray40", …) or "r,g,b,a" with integers of 0 to 255; white
/// space around them is ignored. None if it is neither. Alpha has no effect.
std::optional<Color> parse_color(std::string_view text);

}  // namespace ziggurat::lua
