// SPDX-License-Identifier: MIT
#pragma once
// Report card: response times of each controller, at the end of runs with hardware in the loop.

#include <cstdint>
#include <string>
#include <vector>

#include "network/delays.h"
#include "network/reactions.h"
#include "reports/gate.h"
#include "reports/statistics.h"
#include "scene/deadline.h"

namespace ziggurat::reports {

struct ControllerCard {
  std::string controller;                          ///< id in the scene
  std::vector<network::Reaction> reactions;        ///< all, also those of the warm-up
  std::vector<scene::DeadlinePolicy> deadlines{};  ///< of its robots at the end, each once
  network::Injection injected{};                   ///< delays and losses of its messages
  network::Lost lost{};                            ///< messages lost by the injection
  Statistics statistics{};                         ///< without the warm-up; complete() fills it
};

/// Start of a paced tick.
struct TickStart {
  std::uint32_t world = 0;  ///< 0, and one more after each reset
  std::uint32_t tick = 0;
  double late_s = 0;     ///< wall time after its moment; waking up takes some microseconds
  bool is_late = false;  ///< the ticks before it took longer than until its moment
};

struct ReportCard {
  std::string scene;  ///< path as given
  std::uint64_t seed = 0;
  std::string date;           ///< of the start of the run: "2026-11-22T18:55:00Z"
  double period_s = 0;        ///< wall time from tick to tick; 0: not paced
  std::uint64_t ticks = 0;    ///< the last one
  std::uint64_t warm_up = 0;  ///< so many ticks, from tick 0 on, do not count
  std::vector<Condition> gate;
  std::vector<ControllerCard> controllers;  ///< in scene order
  std::vector<TickStart> starts;            ///< empty: not paced
  std::vector<std::string> robots;          ///< ids, for Reaction::robot

  // complete() fills these; without the warm-up.
  std::uint64_t counted_starts = 0, late_starts = 0;
  Percentiles start_s{};  ///< of TickStart::late_s
};

/// Sorts reactions and starts by world and tick, and fills the statistics.
void complete(ReportCard& card);

// The following expect a complete card.

/// Quantity of a condition, in its unit.
double measured(const ReportCard& card, const ControllerCard& controller,
                const Condition& condition);
/// Whether a controller meets a condition. One of which no reaction counts meets none.
bool meets(const ReportCard& card, const ControllerCard& controller, const Condition& condition);
/// Whether all meet all, and there is one. True without a gate.
bool passes(const ReportCard& card);

/// As text: "observations 5 ms ± 2 ms, 1 % lost; commands 4 ms".
std::string to_text(const network::Injection& injection);
/// "hold:18, drop:50:3", or "wait".
std::string to_text(const std::vector<scene::DeadlinePolicy>& deadlines);
/// Measured value of a condition: "p99<20ms: 14 ms".
std::string to_text(const ReportCard& card, const ControllerCard& controller,
                    const Condition& condition);

/// Several lines without line feed at the end.
std::string to_text(const ReportCard& card);

// Contents of files.
std::string to_json(const ReportCard& card);
/// A line per reaction below a line of names: world, tick, how late the tick began, whether it is
/// of the warm-up, controller, first robot of it in its session, outcome, and wall time.
std::string to_csv(const ReportCard& card);
/// Histograms with the deadlines and the verdict, as a picture.
std::string to_svg(const ReportCard& card);

}  // namespace ziggurat::reports
