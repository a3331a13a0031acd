#pragma once
// Texts of peers, for a terminal.

#include <string>
#include <string_view>

namespace ziggurat::text {

/// The text with control characters written as \u001b, other than line feeds and tabs, and so those that change
/// the order of what follows or are not seen: escape sequences have no effect on a terminal, and two names
/// that differ look different. Bytes that are not UTF-8 become U+FFFD.
std::string printable(std::string_view text);

/// The text with four spaces before each line but the first: none of them looks like one of the program's own.
std::string indented(std::string_view text);

bool is_utf8(std::string_view text);

}  // namespace ziggurat::text
