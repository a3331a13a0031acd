#include "network/glob.h"

#include <cstddef>
#include <optional>

namespace ziggurat::network {
namespace {

struct SetMatch {
  bool matched;
  std::size_t length;  // of the set in the pattern, brackets included
};

/// The set that starts at pattern[0] == '[' against one character; none if it is never closed.
std::optional<SetMatch> match_set(std::string_view pattern, char character) {
  std::size_t i = 1;
  const bool negated = i < pattern.size() && (pattern[i] == '!' || pattern[i] == '^');
  if (negated) ++i;
  const std::size_t first = i;
  const auto value = static_cast<unsigned char>(character);
  bool found = false;
  for (; i < pattern.size(); ++i) {
    if (pattern[i] == ']' && i > first) return SetMatch{found != negated, i + 1};
    const auto low = static_cast<unsigned char>(pattern[i]);
    auto high = low;
    if (i + 2 < pattern.size() && pattern[i + 1] == '-' && pattern[i + 2] != ']') {
      high = static_cast<unsigned char>(pattern[i + 2]);
      i += 2;
    }
    found = found || (low <= value && value <= high);
  }
  return std::nullopt;
}

/// Length of the pattern's first element if it matches the character, 0 if not.
std::size_t match_one(std::string_view pattern, char character) {
  if (pattern.empty()) return 0;
  if (pattern[0] == '?') return 1;
  if (pattern[0] == '[') {
    if (const auto set = match_set(pattern, character)) return set->matched ? set->length : 0;
  }
  return pattern[0] == character ? 1 : 0;
}

}  // namespace

bool has_wildcards(std::string_view pattern) {
  return pattern.find_first_of("*?[") != std::string_view::npos;
}

bool matches(std::string_view pattern, std::string_view text) {
  std::size_t p = 0;
  std::size_t t = 0;
  std::optional<std::size_t> star;  // where to go on after the last `*`
  std::size_t retry = 0;            // where its match ends, so far
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = ++p;
      retry = t;
    } else if (const std::size_t length = match_one(pattern.substr(p), text[t])) {
      p += length;
      ++t;
    } else if (star) {
      p = *star;
      t = ++retry;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

}  // namespace ziggurat::network
