// SPDX-License-Identifier: MIT
#pragma once
// Texts of peers, for a terminal.

#include <cstddef>
#include <string>
#include <string_view>

namespace ziggurat::text {

/// Text in which control characters, except line feeds and tabs, are written as \u001b. The same
/// holds for characters that change the order of text or are invisible. Escape sequences have no
/// effect on a terminal, and two names that differ look different. Bytes that are not UTF-8 become
/// U+FFFD.
std::string printable(std::string_view text);

/// The same for JSON, in which a character beyond U+FFFF is written as two numbers.
std::string printable_json(std::string_view json);

/// Beginning of a longer text, and "…", for text that comes from a peer.
/// @param most  bytes of the result
std::string printable_part(std::string_view text, std::size_t most = 4096);

/// The text with four spaces before each line but the first: none of them looks like one of the
/// program's own.
std::string indented(std::string_view text);

bool is_utf8(std::string_view text);

}  // namespace ziggurat::text
