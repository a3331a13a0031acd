// SPDX-License-Identifier: MIT
#include "text/names.h"

#include <algorithm>
#include <vector>

namespace ziggurat::text {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  const std::size_t width = b.size() + 1;
  std::vector<std::size_t> table((a.size() + 1) * width);
  const auto at = [&](std::size_t i, std::size_t j) -> std::size_t& {
    return table[i * width + j];
  };
  for (std::size_t i = 0; i <= a.size(); ++i) at(i, 0) = i;
  for (std::size_t j = 0; j <= b.size(); ++j) at(0, j) = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = at(i - 1, j - 1) + (a[i - 1] == b[j - 1] ? 0 : 1);
      at(i, j) = std::min({at(i - 1, j) + 1, at(i, j - 1) + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        at(i, j) = std::min(at(i, j), at(i - 2, j - 2) + 1);
      }
    }
  }
  return at(a.size(), b.size());
}

std::string closest(std::string_view word, std::span<const std::string> candidates) {
  constexpr std::size_t longest =
      256;  // of what a person has mistyped; the cost grows with its square
  if (word.size() > longest) return {};
  const std::string* best = nullptr;
  std::size_t best_distance = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const auto& candidate : candidates) {
    const bool begins = word.size() > 3 && candidate.starts_with(word);
    if (!begins && candidate.size() > word.size() + best_distance) continue;
    const std::size_t away = begins ? 1 : edit_distance(word, candidate);
    if (away < best_distance) {
      best = &candidate;
      best_distance = away;
    }
  }
  return best ? *best : std::string();
}

std::string advice(std::string_view word, std::span<const std::string> candidates,
                   std::string_view otherwise) {
  const std::string meant = closest(word, candidates);
  return meant.empty() ? std::string(otherwise) : "did you mean '" + meant + "'?";
}

}  // namespace ziggurat::text
