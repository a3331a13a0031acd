// SPDX-License-Identifier: MIT
#include "network/glob.h"

#include <optional>

namespace ziggurat::network {
namespace {

using Characters = std::bitset<256>;

struct Set {
  Characters characters;
  std::size_t length = 0;  // in the pattern, brackets included
};

/// The set that starts at pattern[0] == '['; none if it is never closed.
std::optional<Set> read_set(std::string_view pattern) {
  std::size_t i = 1;
  const bool is_negated = i < pattern.size() && (pattern[i] == '!' || pattern[i] == '^');
  if (is_negated) ++i;
  const std::size_t first = i;
  Set set;
  for (; i < pattern.size(); ++i) {
    if (pattern[i] == ']' && i > first) {
      if (is_negated) set.characters.flip();
      set.length = i + 1;
      return set;
    }
    const auto low = static_cast<unsigned char>(pattern[i]);
    auto high = low;
    if (i + 2 < pattern.size() && pattern[i + 1] == '-' && pattern[i + 2] != ']') {
      high = static_cast<unsigned char>(pattern[i + 2]);
      i += 2;
    }
    for (unsigned each = low; each <= high; ++each) set.characters.set(each);
  }
  return std::nullopt;
}

}  // namespace

bool has_wildcards(std::string_view pattern) {
  return pattern.find_first_of("*?[") != std::string_view::npos;
}

Glob::Glob(std::string_view pattern) {
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (pattern[i] == '*' && !elements_.empty() && elements_.back().is_star) continue;
    Element& element = elements_.emplace_back();
    const auto set = pattern[i] == '[' ? read_set(pattern.substr(i)) : std::nullopt;
    if (set) {
      element.characters = set->characters;
      i += set->length - 1;
    } else if (pattern[i] == '*') {
      element.is_star = true;
    } else if (pattern[i] == '?') {
      element.characters.set();
    } else {
      element.characters.set(static_cast<unsigned char>(pattern[i]));
    }
  }
}

bool Glob::matches(std::string_view text) const {
  std::size_t e = 0;
  std::size_t t = 0;
  std::optional<std::size_t> star;  // where to go on after the last `*`
  std::size_t retry = 0;            // where its match ends, so far
  while (t < text.size()) {
    if (e < elements_.size() && elements_[e].is_star) {
      star = ++e;
      retry = t;
    } else if (e < elements_.size() &&
               elements_[e].characters[static_cast<unsigned char>(text[t])]) {
      ++e;
      ++t;
    } else if (star) {
      e = *star;
      t = ++retry;
    } else {
      return false;
    }
  }
  while (e < elements_.size() && elements_[e].is_star) ++e;
  return e == elements_.size();
}

}  // namespace ziggurat::network
