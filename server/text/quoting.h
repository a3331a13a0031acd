// SPDX-License-Identifier: MIT
#pragma once
// Texts as other programs read them: words of a shell, fields of CSV, texts of HTML.

#include <string>
#include <string_view>

namespace ziggurat::text {

/// Whether a shell takes the word as it stands.
bool is_plain_word(std::string_view word);

/// A word for /bin/sh: in single quotes, unless it is plain.
std::string shell_word(std::string_view word);

/// A field of CSV (RFC 4180): in double quotes only if it must be. Before a text that a spreadsheet
/// would compute as a formula stands an apostrophe: one that begins with = + - @, a tab or the end
/// of a line, other than numbers.
std::string csv_field(const std::string& text);

/// A printable text between tags of HTML, or in an attribute.
std::string html_text(std::string_view text);

}  // namespace ziggurat::text
