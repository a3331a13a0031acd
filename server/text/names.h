// SPDX-License-Identifier: MIT
#pragma once
// Misspelt names: what was probably meant.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace ziggurat::text {

/// The number of insertions, deletions, replacements and swaps of neighbours between two words.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The candidate that a misspelt word most likely meant; empty if none is near.
std::string closest(std::string_view word, std::span<const std::string> candidates);

/// The end of a message on an unknown word: `did you mean 'x'?`, otherwise `otherwise`.
std::string advice(std::string_view word, std::span<const std::string> candidates,
                   std::string_view otherwise);

}  // namespace ziggurat::text
