#include "text/printable.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

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

/// The character at the beginning, U+2000 to U+207F, if it changes the order in which what follows is
/// shown, or begins a line; otherwise 0.
unsigned reorders_text(std::string_view text) {
  if (byte(text, 0) != 0xe2 || (byte(text, 1) & 0xfe) != 0x80 || byte(text, 2) < 0x80) return 0;
  const unsigned code = 0x2000U + ((byte(text, 1) & 1U) << 6) + (byte(text, 2) & 0x3fU);
  const bool is_mark = code == 0x200e || code == 0x200f;
  const bool is_one = (code >= 0x2028 && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
  return is_mark || is_one ? code : 0;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const auto plain = std::ranges::find_if_not(text, is_plain) - text.begin();
    result.append(text.substr(0, static_cast<std::size_t>(plain)));
    text.remove_prefix(static_cast<std::size_t>(plain));
    if (text.empty()) break;
    const std::size_t length = length_of_character(text);
    const bool is_control = length == 1 || (byte(text, 0) == 0xc2 && byte(text, 1) < 0xa0);
    const unsigned reordering = reorders_text(text);
    if (length == 0) {
      result += "\xef\xbf\xbd";
    } else if (is_control) {
      result += fmt::format("\\u{:04x}", byte(text, length - 1));
    } else if (reordering != 0) {
      result += fmt::format("\\u{:04x}", reordering);
    } else {
      result.append(text.substr(0, length));
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return result;
}

}  // namespace ziggurat::text
