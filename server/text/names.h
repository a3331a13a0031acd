#pragma once
// Misspelt names: what was probably meant.

#include <span>
#include <string>
#include <string_view>

namespace ziggurat::text {

/// The candidate that a misspelt word most likely meant; empty if none is near.
std::string closest(std::string_view word, std::span<const std::string> candidates);

}  // namespace ziggurat::text
