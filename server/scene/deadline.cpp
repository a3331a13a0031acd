// SPDX-License-Identifier: MIT
// deadline, deadline_ms and miss_budget of <controllers> and of each controller.

#include "scene/deadline.h"

#include <fmt/ranges.h>

#include <array>

#include "scene/draft.h"

namespace ziggurat::scene {
namespace {

constexpr std::array<std::string_view, 5> actions{"wait", "hold", "zero", "drop", "stop"};

struct ActionReader {
  Value<DeadlineAction> operator()(std::string_view text) const {
    if (const auto action = deadline_action(text)) return *action;
    return Wrong{"is no deadline action; " + advice(text, actions)};
  }
  /// All of them.
  std::string words() const { return fmt::format("{}", fmt::join(actions, "|")); }
};

}  // namespace

std::optional<DeadlineAction> deadline_action(std::string_view name) {
  for (std::size_t i = 0; i < actions.size(); ++i) {
    if (actions[i] == name) return static_cast<DeadlineAction>(i + 1);
  }
  return std::nullopt;
}

std::string to_text(const DeadlinePolicy& policy) {
  std::string text(actions[static_cast<std::size_t>(policy.action) - 1]);
  if (policy.action == DeadlineAction::wait) return text;
  text += fmt::format(":{}", policy.wall_deadline_ms);
  if (policy.miss_budget > 0) text += fmt::format(":{}", policy.miss_budget);
  return text;
}

std::optional<DeadlinePolicy> read_deadline(Element& element,
                                            const std::optional<DeadlinePolicy>& usual) {
  const auto action = element.optional("deadline", ActionReader());
  const auto deadline_ms = element.optional("deadline_ms", In{"ms", positive_count});
  const auto miss_budget = element.optional("miss_budget", count);
  const bool is_wait = action == DeadlineAction::wait;
  if (is_wait || !element.has("deadline")) {
    for (const char* attribute : {"deadline_ms", "miss_budget"}) {
      if (!element.has(attribute)) continue;
      element.fault_at(attribute, is_wait ? "has no effect beside deadline=\"wait\", which waits "
                                            "forever; remove it, or write deadline=\"hold\""
                                          : "needs a deadline; write deadline=\"hold\" beside it, "
                                            "or zero, drop or stop");
    }
    return is_wait ? DeadlinePolicy{} : usual;
  }
  if (!action) return usual;
  if (!element.has("deadline_ms")) {
    element.fault_at("deadline",
                     "needs a time; write deadline_ms=\"50\" beside it, "
                     "or deadline=\"wait\"");
  }
  return DeadlinePolicy{*action, deadline_ms.value_or(1), miss_budget.value_or(0)};
}

}  // namespace ziggurat::scene
