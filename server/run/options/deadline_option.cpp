// SPDX-License-Identifier: MIT
#include "run/options/deadline_option.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "run/options/controller_option.h"
#include "text/numbers.h"

namespace ziggurat::run {
namespace {

using scene::DeadlineAction;

[[noreturn]] void refuse_deadline(const std::string& value, std::string_view why) {
  throw text::UsageError(fmt::format(
      "--deadline is '{}': {}; write for example wait, hold:50, zero:50:10, drop:200 or "
      "CONTROLLER=stop:1000",
      value, why));
}

std::uint32_t to_count(const std::string& value, const std::string& text) {
  const auto number = text::to_integer("--deadline " + value, text);
  if (number > std::numeric_limits<std::uint32_t>::max())
    refuse_deadline(value, text + " is too large");
  return static_cast<std::uint32_t>(number);
}

/// Removes the text up to the next colon, and the colon.
std::string next_part(std::string& text) {
  const auto colon = text.find(':');
  std::string part = text.substr(0, colon);
  text = colon == std::string::npos ? std::string() : text.substr(colon + 1);
  return part;
}

}  // namespace

DeadlineOption to_deadline(const std::string& value) {
  DeadlineOption option;
  const auto equals = value.rfind('=');  // ids may contain one
  if (equals == 0) refuse_deadline(value, "there is no controller before the =");
  if (equals != std::string::npos) option.controller = value.substr(0, equals);
  std::string rest = equals == std::string::npos ? value : value.substr(equals + 1);
  const bool has_budget = std::ranges::count(rest, ':') > 1;
  if (std::ranges::count(rest, ':') > 2) refuse_deadline(value, "it has more than three parts");
  const std::string name = next_part(rest);
  const auto action = scene::deadline_action(name);
  if (!action) refuse_deadline(value, fmt::format("there is no action '{}'", name));
  option.policy.action = *action;
  if (*action == DeadlineAction::wait) {
    if (!rest.empty()) refuse_deadline(value, "wait takes no milliseconds");
    return option;
  }
  if (rest.empty()) refuse_deadline(value, fmt::format("{} needs a deadline in ms", name));
  option.policy.wall_deadline_ms = to_count(value, next_part(rest));
  if (option.policy.wall_deadline_ms == 0)
    refuse_deadline(value, "the deadline must be at least 1 ms");
  if (has_budget) option.policy.miss_budget = to_count(value, rest);
  return option;
}

DeadlinesOfRun deadlines_of(const std::vector<DeadlineOption>& options, const scene::Scene& scene,
                            const scene::DeadlinePolicy& otherwise) {
  DeadlinesOfRun deadlines;
  deadlines.of_others.policy = otherwise;
  const auto add = [&](const auto& from) {
    deadlines.all.push_back({.policy = from.deadline.value_or(otherwise)});
  };
  std::ranges::for_each(scene.controllers, add);
  std::ranges::for_each(scene.directors, add);
  apply_by_awaited("--deadline", options, scene, [&](const DeadlineOption& option, std::size_t i) {
    deadlines.all[i] = {.policy = option.policy, .is_fixed = true};
  });
  for (const DeadlineOption& option : options) {
    if (option.controller.empty())
      deadlines.of_others = {.policy = option.policy, .is_fixed = true};
  }
  return deadlines;
}

}  // namespace ziggurat::run
