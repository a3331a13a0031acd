// SPDX-License-Identifier: MIT
#include "scene/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "scene/names.h"

namespace ziggurat::scene {
namespace {

constexpr std::size_t most_notices = 1000;
constexpr std::size_t most_advised = 50;  // comparing long names with many takes milliseconds

}  // namespace

void Report::fault(Location where, std::string text, std::vector<std::string_view> causes) {
  if (!subject.empty()) text += fmt::format(" (in {})", subject);
  const std::string& file = files_[where.file];
  entries_.push_back({{Problem::Severity::fault, file, where, std::move(text)}, std::move(causes)});
  if (++faults_ < most_faults_) return;
  entries_.push_back({{Problem::Severity::fault, file, where,
                       fmt::format("{} faults; the rest of the file was not read", faults_)},
                      {}});
  throw TooManyFaults{};
}

void Report::notice(Location where, std::string text) {
  if (noticed_.size() > most_notices || !noticed_.insert(text).second) return;
  if (noticed_.size() > most_notices)
    text = fmt::format("{} notices; others are not told", most_notices);
  entries_.push_back({{Problem::Severity::notice, files_[where.file], where, std::move(text)}, {}});
}

void Report::warn(Location where, std::string_view kind, std::string text) {
  if (!subject.empty()) text += fmt::format(" (in {})", subject);
  Problem problem{Problem::Severity::warning, files_[where.file], where, std::move(text)};
  const auto [known, is_first] = warnings_.try_emplace(kind, Count{entries_.size(), 0});
  if (is_first) return entries_.push_back({std::move(problem), {}});
  ++known->second.more;
  Problem& first = entries_[known->second.entry].problem;
  if (where < first.where) first = std::move(problem);
}

std::string Report::advice(std::string_view name, const std::vector<std::string>& candidates) {
  if (++advised_ <= most_advised) return scene::advice(name, candidates);
  const std::vector<std::string_view> views(candidates.begin(), candidates.end());
  return list_known(views);
}

void Report::no_effect_yet(Location where, std::string_view plural) {
  notice(where, fmt::format("{} are checked, but have no effect yet", plural));
}

std::string Report::place(Location where) const {
  return fmt::format("{}:{}:{}", files_[where.file], where.line, where.column);
}

std::string Report::place(Location where, Location reader) const {
  if (where.line == 0) return {};
  if (where.file != reader.file) return " at " + place(where);
  return fmt::format(" at line {}", where.line);
}

bool Report::follows(const Entry& entry) const {
  return std::ranges::any_of(entry.causes,
                             [&](std::string_view cause) { return left_out_.contains(cause); });
}

std::vector<Problem> Report::problems() const {
  // Should each fault follow from another, all of them are told.
  const bool has_root = std::ranges::any_of(entries_, [&](const Entry& entry) {
    return entry.problem.severity == Problem::Severity::fault && !follows(entry);
  });
  std::vector<Problem> sorted;
  for (const Entry& entry : entries_) {
    if (!has_root || !follows(entry)) sorted.push_back(entry.problem);
    const auto index = static_cast<std::size_t>(&entry - entries_.data());
    for (const auto& [kind, count] : warnings_) {
      if (count.entry == index && count.more > 0) {
        sorted.back().text += fmt::format("; and {} more like this", count.more);
      }
    }
  }
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Problem& a, const Problem& b) { return a.where < b.where; });
  return sorted;
}

}  // namespace ziggurat::scene
