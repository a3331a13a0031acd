// SPDX-License-Identifier: MIT
#include "reports/report_card.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <tuple>

namespace ziggurat::reports {
namespace {

using network::Reaction;

constexpr std::size_t bar_length = 40;  // characters

double counted(const Condition& condition, std::uint64_t some, std::uint64_t all) {
  if (!condition.is_share) return static_cast<double>(some);
  return all > 0 ? static_cast<double>(some) / static_cast<double>(all) : 0;
}

/// Without any the world waited for every answer.
bool has_deadlines(const ReportCard& card) {
  return std::ranges::any_of(card.controllers, [](const ControllerCard& controller) {
    return std::ranges::any_of(controller.deadlines, [](const scene::DeadlinePolicy& policy) {
      return policy.action != scene::DeadlineAction::wait;
    });
  });
}

/// The histogram as text. Five bins, a quarter of a decade, make one line.
std::string bars(const Statistics& statistics) {
  constexpr std::size_t together = 5;
  std::array<std::uint64_t, bins::count / together> sums{};
  for (std::size_t bin = 0; bin < bins::count; ++bin) {
    sums[bin / together] += statistics.histogram[bin];
  }
  const std::uint64_t most = *std::ranges::max_element(sums);
  std::string text;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (sums[i] == 0) continue;
    const auto length = (sums[i] * bar_length + most - 1) / most;
    text += fmt::format("\n    from {:>8.3f} ms  {:>9}  {}", bins::begin_of(i * together) * 1e3,
                        sums[i], std::string(static_cast<std::size_t>(length), '#'));
  }
  return text;
}

std::string injected(const ControllerCard& controller) {
  if (!controller.injected.any()) return {};
  return fmt::format("\n    injected: {}; {} observations and {} commands were lost",
                     to_text(controller.injected), controller.lost.observations,
                     controller.lost.commands);
}

std::string words_of(const network::Disturbance& disturbance) {
  const auto ms = [](std::chrono::nanoseconds time) {
    return static_cast<double>(time.count()) * 1e-6;
  };
  std::string text;
  if (disturbance.latency.count() > 0) text = fmt::format("{:g} ms", ms(disturbance.latency));
  if (disturbance.jitter.count() > 0) text += fmt::format(" ± {:g} ms", ms(disturbance.jitter));
  if (disturbance.loss == 0) return text;
  return text + fmt::format("{}{:g} % lost", text.empty() ? "" : ", ", disturbance.loss * 100);
}

std::string head(const ReportCard& card) {
  std::string text = fmt::format("report card: {}, seed {}, {}\n  {} ticks", card.scene, card.seed,
                                 card.date, card.ticks);
  if (card.period_s > 0) text += fmt::format(" of {:g} ms", card.period_s * 1e3);
  if (card.warm_up > 0) text += fmt::format(", the first {} not counted", card.warm_up);
  if (card.starts.empty()) return text;
  return text + fmt::format(
                    "; {} of {} began late; starts were behind by p50 {:.3f} ms, p99 {:.3f} ms, "
                    "max {:.3f} ms",
                    card.late_starts, card.counted_starts, card.start_s.p50 * 1e3,
                    card.start_s.p99 * 1e3, card.start_s.max * 1e3);
}

std::string body(const ReportCard& card, const ControllerCard& controller) {
  const Statistics& found = controller.statistics;
  const Percentiles& p = found.wall_s;
  std::string text = fmt::format(
      "\n  controller '{}', deadline {}: {} observations; {} answered in time, {} late, {} never\n"
      "    misses at {} of {} ticks, at most {} in a row\n"
      "    p50 {:.3f} ms, p90 {:.3f} ms, p99 {:.3f} ms, p99.9 {:.3f} ms, max {:.3f} ms, "
      "jitter {:.3f} ms",
      controller.controller, to_text(controller.deadlines), found.count(), found.in_time,
      found.late, found.unanswered, found.misses, found.ticks, found.longest_run, p.p50 * 1e3,
      p.p90 * 1e3, p.p99 * 1e3, p.p999 * 1e3, p.max * 1e3, found.jitter_s * 1e3);
  for (std::size_t i = 0; i < found.worst.size(); ++i) {
    const Reaction& one = found.worst[i];
    text +=
        fmt::format("{}{:.3f} ms at tick {}{}", i == 0 ? "\n    worst: " : ", ", one.seconds * 1e3,
                    one.tick, one.kind == Reaction::Kind::unanswered ? " (never answered)" : "");
  }
  text += injected(controller) + bars(found);
  for (const Condition& condition : card.gate) {
    text += fmt::format("\n    {}  {}", meets(card, controller, condition) ? "met " : "MISSED",
                        to_text(card, controller, condition));
  }
  return text;
}

}  // namespace

void complete(ReportCard& card) {
  const auto is_counted = [&](const auto& one) { return one.tick >= card.warm_up; };
  for (ControllerCard& controller : card.controllers) {
    std::ranges::sort(controller.reactions, {}, [](const Reaction& one) {
      return std::tuple(one.world, one.tick, one.robot);
    });
    std::vector<Reaction> those;
    std::ranges::copy_if(controller.reactions, std::back_inserter(those), is_counted);
    controller.statistics = measure(those);
  }
  std::ranges::sort(card.starts, {},
                    [](const TickStart& one) { return std::tuple(one.world, one.tick); });
  std::vector<double> late;
  for (const TickStart& start : card.starts) {
    if (!is_counted(start)) continue;
    late.push_back(start.late_s);
    card.late_starts += start.is_late ? 1 : 0;
  }
  card.counted_starts = late.size();
  card.start_s = percentiles(late);
}

double measured(const ReportCard& card, const ControllerCard& controller,
                const Condition& condition) {
  const Statistics& found = controller.statistics;
  switch (condition.subject) {
    case Condition::Subject::p50:
      return found.wall_s.p50;
    case Condition::Subject::p90:
      return found.wall_s.p90;
    case Condition::Subject::p99:
      return found.wall_s.p99;
    case Condition::Subject::p999:
      return found.wall_s.p999;
    case Condition::Subject::max:
      return found.wall_s.max;
    case Condition::Subject::jitter:
      return found.jitter_s;
    case Condition::Subject::misses:
      return counted(condition, found.misses, found.ticks);
    case Condition::Subject::run:
      return counted(condition, found.longest_run, found.ticks);
    case Condition::Subject::late:
      return counted(condition, card.late_starts, card.counted_starts);
  }
  return 0;
}

bool meets(const ReportCard& card, const ControllerCard& controller, const Condition& condition) {
  if (is_of_misses(condition.subject) && !has_deadlines(card)) return false;
  return controller.statistics.count() > 0 &&
         measured(card, controller, condition) < condition.limit;
}

bool passes(const ReportCard& card) {
  if (card.controllers.empty()) return card.gate.empty();
  return std::ranges::all_of(card.controllers, [&](const ControllerCard& controller) {
    return std::ranges::all_of(
        card.gate, [&](const Condition& condition) { return meets(card, controller, condition); });
  });
}

std::string to_text(const network::Injection& injection) {
  if (injection.observations == injection.commands) {
    return "each way " + words_of(injection.observations);
  }
  std::string text;
  if (injection.observations.any()) text = "observations " + words_of(injection.observations);
  if (!injection.commands.any()) return text;
  return text + (text.empty() ? "" : "; ") + "commands " + words_of(injection.commands);
}

std::string to_text(const std::vector<scene::DeadlinePolicy>& deadlines) {
  std::string text;
  for (const auto& policy : deadlines) text += (text.empty() ? "" : ", ") + to_text(policy);
  return text.empty() ? "none" : text;
}

std::string to_text(const ReportCard& card, const ControllerCard& controller,
                    const Condition& condition) {
  if (controller.statistics.count() == 0) return condition.text + ": no observation counts";
  if (is_of_misses(condition.subject) && !has_deadlines(card)) {
    return condition.text + ": no controller had a deadline, so nothing could be missed";
  }
  const double value = measured(card, controller, condition);
  if (condition.is_share) return fmt::format("{}: {:.3g} %", condition.text, value * 100);
  if (is_time(condition.subject)) return fmt::format("{}: {:.3g} ms", condition.text, value * 1e3);
  return fmt::format("{}: {:g}", condition.text, value);
}

std::string to_text(const ReportCard& card) {
  std::string text = head(card);
  for (const ControllerCard& controller : card.controllers) text += body(card, controller);
  if (!card.gate.empty()) text += passes(card) ? "\n  gate: met" : "\n  gate: not met";
  if (!card.gate.empty() && card.controllers.empty()) text += ": no controller was measured";
  return text;
}

}  // namespace ziggurat::reports
