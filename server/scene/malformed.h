// SPDX-License-Identifier: MIT
#pragma once
// Mistakes that make a text no XML, found where they were made: a parser only notices where they
// show, often lines later.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace ziggurat::scene {

/// Whether a line ends with this character: a line feed, or a carriage return without one.
inline bool ends_line(std::string_view text, std::size_t i) {
  return text[i] == '\n' || (text[i] == '\r' && (i + 1 == text.size() || text[i + 1] != '\n'));
}

struct Malformed {
  std::size_t offset = 0;  ///< into the text
  std::string text;        ///< what is wrong, and what to write
};

/// The first mistake among quotes, attributes and tags; nothing if these are in order.
/// @param source  UTF-8
std::optional<Malformed> find_malformed(std::string_view source);

struct Unescaped {
  std::optional<Malformed> fault;     ///< the first < inside an attribute's value
  std::optional<std::size_t> dashes;  ///< offset of the first -- inside a comment
  std::optional<std::size_t>
      declaration;  ///< offset of the first <?xml that is not the text's beginning
};

/// Finds text that is not XML by its standard, although the parser reads it.
/// @param source  that the parser has read without error
Unescaped find_unescaped(std::string_view source);

}  // namespace ziggurat::scene
