// SPDX-License-Identifier: MIT
#pragma once
// Patterns for ids: `*` any text, `?` any character, `[a-z]` one of a set, `[!a-z]` one outside it.

#include <bitset>
#include <cstddef>
#include <string_view>
#include <vector>

namespace ziggurat::network {

// Limits for the patterns of a message; they bound the time of matching.
inline constexpr std::size_t most_patterns = 64;
inline constexpr std::size_t longest_pattern = 256;  ///< [bytes]

bool has_wildcards(std::string_view pattern);

/// A pattern for many texts. An unclosed `[` stands for itself.
class Glob {
 public:
  explicit Glob(std::string_view pattern);
  /// Whole-text match in time O(text x the shorter of both) at worst.
  bool matches(std::string_view text) const;

 private:
  struct Element {
    bool is_star = false;
    std::bitset<256> characters = {};  // one of these; of a star none
  };
  std::vector<Element> elements_;
};

/// The same for one text.
inline bool matches(std::string_view pattern, std::string_view text) {
  return Glob(pattern).matches(text);
}

}  // namespace ziggurat::network
