// SPDX-License-Identifier: MIT
#include "text/printable.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>

namespace ziggurat::text {
namespace {

unsigned char byte(std::string_view text, std::size_t i) {
  return i < text.size() ? static_cast<unsigned char>(text[i]) : 0;
}

bool is_plain(char c) {
  const auto code = static_cast<unsigned char>(c);
  return (code >= 0x20 && code < 0x7f) || c == '\n' || c == '\t';
}

/// The bytes of the UTF-8 character at the beginning, as the Unicode standard's table 3-7 has them;
/// 0 if it is none.
std::size_t length_of_character(std::string_view text) {
  const unsigned char first = byte(text, 0), second = byte(text, 1);
  const auto between = [](unsigned char value, int low, int high) {
    return value >= low && value <= high;
  };
  const bool third = between(byte(text, 2), 0x80, 0xbf),
             fourth = between(byte(text, 3), 0x80, 0xbf);
  if (first < 0x80) return 1;
  if (between(first, 0xc2, 0xdf)) return between(second, 0x80, 0xbf) ? 2 : 0;
  if (between(first, 0xe0, 0xef)) {
    const int low = first == 0xe0 ? 0xa0 : 0x80, high = first == 0xed ? 0x9f : 0xbf;
    return between(second, low, high) && third ? 3 : 0;
  }
  if (between(first, 0xf0, 0xf4)) {
    const int low = first == 0xf0 ? 0x90 : 0x80, high = first == 0xf4 ? 0x8f : 0xbf;
    return between(second, low, high) && third && fourth ? 4 : 0;
  }
  return 0;
}

/// The number of the character that these bytes are; 0 for none.
char32_t code_of(std::string_view character) {
  constexpr std::array<unsigned char, 5> first_bits{0, 0x7f, 0x1f, 0x0f, 0x07};  // by length
  char32_t code = byte(character, 0) & first_bits[character.size()];
  for (std::size_t i = 1; i < character.size(); ++i)
    code = code << 6 | (byte(character, i) & 0x3fU);
  return code;
}

struct Range {
  char32_t first, last;
};

/// Unicode 15's categories Cc above ASCII, Cf, Zl and Zp: they control the terminal, change the
/// order in which others are shown, begin a line, or are not seen at all.
constexpr Range unseen[] = {
    {0x80, 0x9f},       {0xad, 0xad},       {0x600, 0x605},     {0x61c, 0x61c},
    {0x6dd, 0x6dd},     {0x70f, 0x70f},     {0x890, 0x891},     {0x8e2, 0x8e2},
    {0x180e, 0x180e},   {0x200b, 0x200f},   {0x2028, 0x202e},   {0x2060, 0x206f},
    {0xfeff, 0xfeff},   {0xfff9, 0xfffb},   {0x110bd, 0x110bd}, {0x110cd, 0x110cd},
    {0x13430, 0x1343f}, {0x1bca0, 0x1bca3}, {0x1d173, 0x1d17a}, {0xe0001, 0xe007f}};

bool is_unseen(char32_t code) {
  return std::ranges::any_of(
      unseen, [=](Range range) { return range.first <= code && code <= range.last; });
}

/// A character that is not plain; empty: a byte that is none.
std::string shown(std::string_view character, bool is_json = false) {
  if (character.empty()) return "\xef\xbf\xbd";
  const char32_t code = code_of(character);
  if (character.size() > 1 && !is_unseen(code)) return std::string(character);
  std::array<char, 16> escaped;
  if (is_json && code > 0xffff) {  // half of it each
    const unsigned rest = code - 0x10000;
    std::snprintf(escaped.data(), escaped.size(), "\\u%04x\\u%04x", 0xd800 | rest >> 10,
                  0xdc00 | (rest & 0x3ff));
  } else {
    std::snprintf(escaped.data(), escaped.size(), "\\u%04x", static_cast<unsigned>(code));
  }
  return escaped.data();
}

enum class Form { plain, json };

std::string all_shown(std::string_view text, Form form) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const auto plain = std::ranges::find_if_not(text, is_plain) - text.begin();
    result.append(text.substr(0, static_cast<std::size_t>(plain)));
    text.remove_prefix(static_cast<std::size_t>(plain));
    if (text.empty()) break;
    const std::size_t length = length_of_character(text);
    result += shown(text.substr(0, length), form == Form::json);
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return result;
}

}  // namespace

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = length_of_character(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

std::string indented(std::string_view text) {
  std::string result;
  for (const char c : text) {
    result += c;
    if (c == '\n') result += "    ";
  }
  return result;
}

std::string printable(std::string_view text) { return all_shown(text, Form::plain); }

std::string printable_json(std::string_view json) { return all_shown(json, Form::json); }

std::string printable_part(std::string_view text, std::size_t most) {
  constexpr std::string_view more = "\u2026";
  std::string result =
      printable(text.substr(0, most + 1));  // a character that is cut is beyond the part
  if (result.size() <= most) return result;
  result.clear();
  for (;;) {
    const std::size_t length = length_of_character(text);
    const std::string next =
        is_plain(text[0]) ? std::string(1, text[0]) : shown(text.substr(0, length));
    if (result.size() + next.size() + more.size() > most) return result.append(more);
    result += next;
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
}

}  // namespace ziggurat::text
