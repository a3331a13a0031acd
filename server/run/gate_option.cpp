#include "run/gate_option.h"

#include <fmt/format.h>

#include <algorithm>

#include "text/numbers.h"

namespace ziggurat::run {

void check_gate(const std::vector<reports::Condition>& gate, const GateContext& context) {
  const bool waits_for_all = !context.deadlines.empty() &&
                             std::ranges::all_of(context.deadlines, [](const auto& deadline) {
                               return deadline.policy.action == scene::DeadlineAction::wait;
                             });
  for (const reports::Condition& condition : gate) {
    if (condition.subject == reports::Condition::Subject::late && !context.is_paced) {
      throw text::UsageError(fmt::format(
          "--gate: '{}' is always met: nothing paces the run, so no tick is late; add --hil or "
          "--real-time, or leave it out",
          condition.text));
    }
    if (reports::is_of_misses(condition.subject) && waits_for_all && !context.may_be_asked) {
      throw text::UsageError(fmt::format(
          "--gate: '{}' is always met: the world waits for every controller; add --hil, or "
          "--deadline hold:50 for example, or leave it out",
          condition.text));
    }
  }
}

}  // namespace ziggurat::run
