#pragma once
// Colors as scripts write them.

#include <optional>
#include <string_view>

#include "ziggurat/led.h"

namespace ziggurat::lua {

/// A name of the scene format ("red", "gray40", …) or "r,g,b,a" with integers of 0 to 255; white
/// space around the numbers is skipped. None if it is neither. Alpha has no effect.
std::optional<Color> parse_color(std::string_view text);

}  // namespace ziggurat::lua
