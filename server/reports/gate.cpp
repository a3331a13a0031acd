// SPDX-License-Identifier: MIT
#include "reports/gate.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <system_error>
#include <utility>

#include "text/numbers.h"
#include "text/shortened.h"

namespace ziggurat::reports {
namespace {

using Subject = Condition::Subject;

constexpr std::array<std::pair<std::string_view, Subject>, 9> subjects{{
    {"p50", Subject::p50},
    {"p90", Subject::p90},
    {"p99", Subject::p99},
    {"p99.9", Subject::p999},
    {"max", Subject::max},
    {"jitter", Subject::jitter},
    {"misses", Subject::misses},
    {"run", Subject::run},
    {"late", Subject::late},
}};

[[noreturn]] void wrong(const std::string& part) {
  throw text::UsageError(fmt::format(
      "--gate: '{}' is not a condition; write for example p99<2ms, max<20ms, misses<0.1% or late<5 "
      "(p50, p90, p99, p99.9, max, jitter: a time in us, ms or s; misses, run, late: a number or a "
      "share in %)",
      part));
}

Condition parse_condition(const std::string& part) {
  const auto sign = part.find('<');
  if (sign == std::string::npos) wrong(part);
  const std::string_view name = text::trimmed(std::string_view(part).substr(0, sign));
  const std::string_view limit = text::trimmed(std::string_view(part).substr(sign + 1));
  const auto subject = std::ranges::find(subjects, name, [](const auto& s) { return s.first; });
  if (subject == subjects.end()) wrong(part);
  Condition condition{subject->second, false, 0, part};
  const auto [end, error] =
      std::from_chars(limit.data(), limit.data() + limit.size(), condition.limit);
  if (error != std::errc()) wrong(part);
  const std::string_view unit =
      text::trimmed(limit.substr(static_cast<std::size_t>(end - limit.data())));
  if (!std::isfinite(condition.limit) || condition.limit < 0) wrong(part);
  if (is_time(condition.subject)) {
    const auto seconds = text::seconds_in(unit);
    if (!seconds) wrong(part);
    condition.limit *= *seconds;
  } else if (unit == "%") {
    condition.is_share = true;
    condition.limit /= 100;
    if (condition.limit > 1)
      throw text::UsageError(
          fmt::format("--gate: '{}' is always met: a share has 100% at most", part));
  } else if (!unit.empty()) {
    wrong(part);
  }
  if (condition.limit == 0) {
    throw text::UsageError(fmt::format(
        "--gate: '{}' is never met: nothing is below 0; write {}", part,
        is_time(condition.subject) ? "a time" : fmt::format("{}<1 for none at all", name)));
  }
  return condition;
}

}  // namespace

std::vector<Condition> parse_gate(const std::string& text) {
  std::vector<Condition> conditions;
  for (const std::string& part : text::split(text, ',')) {
    conditions.push_back(parse_condition(std::string(text::trimmed(part))));
  }
  return conditions;
}

}  // namespace ziggurat::reports
