#pragma once
// White space at the ends of texts.

#include <string_view>

namespace ziggurat::text {

/// The text without spaces, tabs and line ends at its ends.
std::string_view trimmed(std::string_view text);

}  // namespace ziggurat::text
