// SPDX-License-Identifier: MIT
// The end of a run: the last words of its controllers, and those that do not end.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "run/watch.h"

namespace ziggurat::run {
namespace {

using std::chrono::milliseconds;
using Membership = network::RobotStatus::Membership;

constexpr milliseconds between_looks{20};  // at what arrives

/// Grace periods in which controllers may end.
struct GracePeriods {
  milliseconds
      answer;  ///< of controllers that the run has not started, to the message that the run is over
  milliseconds leave;  ///< the same of those that it has started
  int exit_ms;         ///< after that, or after all have left, and again after SIGTERM
};
constexpr GracePeriods usual{milliseconds{2000}, milliseconds{4000}, 1000};
// Together with what else is to be done, less than Signals::patience.
constexpr GracePeriods interrupted{milliseconds{400}, milliseconds{400}, 100};

/// Loss when a Lua process is ended: it has not reported the end of its robots yet.
std::string what_is_lost(const processes::ControllerProcess& slow, std::optional<std::size_t> busy,
                         const world::Layout& layout) {
  std::string text;
  const auto behind = busy ? std::ranges::upper_bound(slow.robots, *busy) : slow.robots.end();
  // Robots that came later have a thread each, in any order.
  if (!slow.pipe && behind != slow.robots.end()) {
    text = fmt::format("; destroy() of {} did not run",
                       processes::names_of({behind, slow.robots.end()}, layout));
  }
  return text + fmt::format("; the last log lines and metrics of {} may be lost",
                            processes::names_of(slow.robots, layout));
}

/// On a process that goes on although the run is over: it is ended by force, and what it still does
/// may be lost. That is a failure, unless all of its robots have left the run or were dropped.
/// @param has_session  a robot of it is in a session
/// @param after        the end of the run [s]
network::Report report_on_slow(const processes::ControllerProcess& slow, bool has_session,
                               std::chrono::duration<double> after, const world::Layout& layout,
                               std::uint64_t tick) {
  const std::string what =
      fmt::format("still ran {:.0f} s after the end of the run, and was ended", after.count());
  network::Report report;
  const bool is_lua = !slow.place_file.empty();
  if (slow.robots.empty() || !has_session) {
    report.notices.push_back(processes::describe(slow, what, layout));
    return report;
  }
  const auto script = processes::busy_script(slow);
  const auto found = std::ranges::find(slow.robots, script ? script->robot : "",
                                       [&](std::size_t robot) { return layout.robots[robot].id; });
  const auto busy = found == slow.robots.end() ? std::nullopt : std::optional(*found);
  auto text = busy ? fmt::format("{}: the script {}", script->place, what)
                   : processes::describe(slow, what, layout);
  if (is_lua) text += what_is_lost(slow, busy, layout);
  report.failures.push_back({busy.value_or(slow.robots.front()), std::move(text), tick});
  return report;
}

}  // namespace

void Watch::end_run(const wire::End& end) {
  const bool is_planned = end.reason != wire::EndReason::interrupted;
  const GracePeriods grace = is_planned ? usual : interrupted;
  server_.finish(end);
  const std::array descriptors{signals_.descriptor()};
  const auto begin = clock::now();
  for (auto waited = clock::duration::zero(); waited < grace.leave; waited = clock::now() - begin) {
    const auto outcome = server_.drain({between_looks, descriptors});
    take_report();
    if (outcome == network::Outcome::complete ||
        (waited >= grace.answer && !controllers_.are_running()))
      break;
    if (signals_.take().interruptions > 0) {
      controllers_.kill();
      break;
    }
  }
  peers_.print_log(now_.tick);
  const auto is_interrupted = [&] {
    server_.drain(
        {milliseconds{0}, {}});  // what does not fit into a socket keeps its process from ending
    take_report();
    return signals_.take().interruptions > 0;
  };
  controllers_.end(grace.exit_ms, is_interrupted, [&](const processes::ControllerProcess& slow) {
    if (!is_planned) return;
    const auto status = server_.status();
    const bool has_session = std::ranges::any_of(slow.robots, [&](std::size_t robot) {
      return status[robot].membership == Membership::held;
    });
    peers_.take(report_on_slow(slow, has_session, clock::now() - begin, world_.simulation.layout(),
                               now_.tick),
                now_.tick);
  });
  server_.drain({between_looks, {}});  // what those that ended meanwhile have said, their failures
  take_report();
  peers_.print_log(now_.tick);
}

}  // namespace ziggurat::run
