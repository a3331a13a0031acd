#include "scene/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace ziggurat::scene {
namespace {

constexpr std::size_t most_faults = 1000;

}  // namespace

void Report::fault(Location where, std::string text) {
  if (!subject.empty()) text += fmt::format(" (in {})", subject);
  const std::string& file = files_[where.file];
  problems_.push_back({Problem::Severity::fault, file, where, std::move(text)});
  if (++faults_ < most_faults) return;
  problems_.push_back({Problem::Severity::fault, file, where,
                       fmt::format("{} faults; the rest of the file was not read", faults_)});
  throw TooManyFaults{};
}

void Report::notice(Location where, std::string text) {
  if (!noticed_.insert(text).second) return;
  problems_.push_back({Problem::Severity::notice, files_[where.file], where, std::move(text)});
}

void Report::no_effect_yet(Location where, std::string_view plural) {
  notice(where, fmt::format("{} are checked, but have no effect yet", plural));
}

std::string Report::place(Location where) const {
  return fmt::format("{}:{}:{}", files_[where.file], where.line, where.column);
}

std::vector<Problem> Report::problems() const {
  std::vector<Problem> sorted = problems_;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Problem& a, const Problem& b) { return a.where < b.where; });
  return sorted;
}

}  // namespace ziggurat::scene
