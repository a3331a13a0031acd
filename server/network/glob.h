#pragma once
// Patterns for ids: `*` any text, `?` any character, `[a-z]` one of a set, `[!a-z]` one outside it.

#include <string_view>

namespace ziggurat::network {

bool has_wildcards(std::string_view pattern);

/// Whole-text match in time O(pattern x text) at worst. An unclosed `[` stands for itself.
bool matches(std::string_view pattern, std::string_view text);

}  // namespace ziggurat::network
