#include "wire/metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wire/fault.h"

namespace ziggurat::wire {
namespace {

constexpr std::size_t longest_name = 64;  // [bytes]

bool is_name(std::string_view text) {
  const auto may_stand = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  };
  return !text.empty() && text.size() <= longest_name && std::ranges::all_of(text, may_stand);
}

}  // namespace

std::optional<Fault> check(const google::protobuf::RepeatedPtrField<v1::Metric>& metrics,
                           const Roster& roster) {
  for (const v1::Metric& metric : metrics) {
    if (auto found = check_position(metric.robot(), roster, "metrics")) return found;
  }
  return check_names_and_values(metrics);
}

std::optional<Fault> check_names_and_values(
    const google::protobuf::RepeatedPtrField<v1::Metric>& metrics) {
  for (const v1::Metric& metric : metrics) {
    if (!is_name(metric.name())) {
      return make_fault(ErrorCode::bad_value, "metrics",
                        fmt::format("The name of a metric must have 1 to {} letters, digits, '_', "
                                    "'-' or '.'.",
                                    longest_name));
    }
    if (!std::isfinite(metric.value())) {
      return make_fault(ErrorCode::bad_value, "metrics",
                        fmt::format("The metric '{}' must be finite.", metric.name()));
    }
  }
  return std::nullopt;
}

void append(const google::protobuf::RepeatedPtrField<v1::Metric>& metrics, const Roster& roster,
            std::vector<Metric>& to) {
  for (const v1::Metric& metric : metrics) {
    if (roster.taken[metric.robot()]) continue;
    to.push_back({roster.robots[metric.robot()], metric.name(), metric.value()});
  }
}

}  // namespace ziggurat::wire
