#pragma once
// Patterns for ids: `*` any text, `?` any character, `[a-z]` one of a set, `[!a-z]` one outside it.

#include <cstddef>
#include <string_view>

namespace ziggurat::network {

// Of a message, wherever they stand in it: they bound the time that matching takes.
inline constexpr std::size_t most_patterns = 64;
inline constexpr std::size_t longest_pattern = 256;  ///< [bytes]

bool has_wildcards(std::string_view pattern);

/// Whole-text match in time O(pattern x text) at worst. An unclosed `[` stands for itself.
bool matches(std::string_view pattern, std::string_view text);

}  // namespace ziggurat::network
