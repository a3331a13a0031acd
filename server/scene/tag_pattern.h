#pragma once
// Which payloads of tags are drawn as a pattern.

#include <optional>
#include <string_view>

namespace ziggurat::scene {

/// The id of AprilTag's family 36h11 that a payload stands for: all of it is an integer 0 to 586.
std::optional<unsigned> tag_pattern(std::string_view payload);

}  // namespace ziggurat::scene
