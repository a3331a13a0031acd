// SPDX-License-Identifier: MIT
#include "text/shortened.h"

#include <algorithm>

namespace ziggurat::text {
namespace {

constexpr std::string_view ellipsis = "…";
constexpr std::size_t longest_word = 160, longest_message = 4000;

bool is_within_character(std::string_view text, std::size_t at) {
  return at > 0 && at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U;
}

std::string_view first_of(std::string_view text, std::size_t size) {
  while (is_within_character(text, size)) --size;
  return text.substr(0, size);
}

std::string_view last_of(std::string_view text, std::size_t size) {
  std::size_t begin = text.size() - size;
  while (is_within_character(text, begin)) ++begin;
  return text.substr(begin);
}

/// Without its middle.
std::string both_ends(std::string_view text, std::size_t beginning, std::size_t ending) {
  return std::string(first_of(text, beginning)).append(ellipsis).append(last_of(text, ending));
}

}  // namespace

std::string shortened(std::string_view text, std::size_t most) {
  if (text.size() <= most) return std::string(text);
  return std::string(first_of(text, most)).append(ellipsis);
}

std::string shortened_message(std::string_view message) {
  constexpr std::string_view white = " \t\r\n";
  std::string result;
  while (!message.empty()) {
    const std::size_t begin = std::min(message.find_first_not_of(white), message.size());
    const std::size_t end = std::min(message.find_first_of(white, begin), message.size());
    const std::string_view word = message.substr(begin, end - begin);
    result += message.substr(0, begin);
    // The end has a path's line and column.
    result += word.size() > longest_word ? both_ends(word, 100, 40) : std::string(word);
    message.remove_prefix(end);
  }
  return result.size() > longest_message ? both_ends(result, 3000, 900) : result;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view white_space = " \t\r\n\v\f";
  const std::size_t begin = text.find_first_not_of(white_space);
  if (begin == std::string_view::npos) return text.substr(0, 0);
  return text.substr(begin, text.find_last_not_of(white_space) - begin + 1);
}

}  // namespace ziggurat::text
