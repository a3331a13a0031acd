// SPDX-License-Identifier: MIT
#include "text/quoting.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <system_error>

#include "text/printable.h"

namespace ziggurat::text {
namespace {

constexpr std::string_view plain_signs = "_./+-,:@";

bool is_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  if (word.ends_with('%')) word.remove_suffix(1);
  double number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  return error != std::errc::invalid_argument && end == word.data() + word.size();
}

/// Also of several, as coordinates and ranges are written.
bool are_numbers(std::string_view words) {
  for (;;) {
    const auto end = std::min(words.find_first_of(", :"), words.size());
    if (!is_number(words.substr(0, end))) return false;
    if (end == words.size()) return true;
    words.remove_prefix(end + 1);
  }
}

bool is_formula(std::string_view text) {
  constexpr std::string_view begins = "=+-@\t\r\n";
  return text.size() > 1 && begins.find(text.front()) != begins.npos && !are_numbers(text);
}

}  // namespace

bool is_plain_word(std::string_view word) {
  return !word.empty() && std::ranges::all_of(word, [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return std::isalnum(byte) != 0 || plain_signs.find(c) != plain_signs.npos || byte >= 0x80;
  });
}

std::string shell_word(std::string_view word) {
  if (is_plain_word(word)) return std::string(word);
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string csv_field(const std::string& unsafe) {
  const std::string text = is_formula(unsafe) ? "'" + unsafe : unsafe;
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += c;
    result += c;
  }
  return result + '"';
}

std::string html_text(std::string_view text) {
  std::string all;
  for (const char letter : printable(text)) {
    if (std::string_view("&<>\"'").find(letter) == std::string_view::npos) {
      all += letter;
    } else {
      all += fmt::format("&#{};", static_cast<int>(letter));
    }
  }
  return all;
}

}  // namespace ziggurat::text
