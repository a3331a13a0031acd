// SPDX-License-Identifier: MIT
#include "reports/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "math/hash.h"
#include "reports/json_text.h"
#include "text/printable.h"

namespace ziggurat::reports {
namespace {

using timing::Phase;

const char* to_string(Ending ending) {
  switch (ending) {
    case Ending::finished:
      return "finished";
    case Ending::interrupted:
      return "interrupted";
    case Ending::shut_down:
      return "shut_down";
    case Ending::forced:
      return "forced";
    case Ending::controller_vanished:
      return "controller_vanished";
    case Ending::failed_fast:
      return "failed_fast";
    case Ending::deadline_missed:
      return "deadline_missed";
    case Ending::reset:
      return "reset";
  }
  return "";
}

double ratio(double numerator, double denominator) {
  return denominator > 0 ? numerator / denominator : 0;
}

/// Which robots and directors failed; their messages were printed when they did.
std::string failed(const std::vector<Summary::Failure>& failures) {
  constexpr std::size_t most = 8;
  std::string text = fmt::format("  {} failed: ", failures.size());
  for (std::size_t i = 0; i < std::min(most, failures.size()); ++i) {
    const Summary::Failure& failure = failures[i];
    text += fmt::format("{}{} {} at tick {}", i == 0 ? "" : ", ",
                        failure.director.empty() ? "robot" : "director",
                        failure.director.empty() ? failure.robot : failure.director, failure.tick);
  }
  if (failures.size() > most) text += fmt::format(" and {} more", failures.size() - most);
  return text + "\n";
}

/// Robots whose controller left before the end.
std::string departed(const std::vector<Summary::Departure>& departures) {
  constexpr std::size_t most = 8;
  std::string text = fmt::format("  {} left before the end: ", departures.size());
  for (std::size_t i = 0; i < std::min(most, departures.size()); ++i) {
    text += fmt::format("{}robot {} at tick {}", i == 0 ? "" : ", ", departures[i].robot,
                        departures[i].tick);
  }
  if (departures.size() > most) text += fmt::format(" and {} more", departures.size() - most);
  return text + "\n";
}

/// A line with the first metrics.
std::string metrics(const std::map<std::string, double>& all) {
  constexpr std::size_t most = 8;
  if (all.empty()) return {};
  std::string text = "  metrics: ";
  std::size_t count = 0;
  for (const auto& [name, value] : all) {
    if (count == most) break;
    text += fmt::format("{}{} = {}", count++ == 0 ? "" : ", ", name, value);
  }
  if (all.size() > most) text += fmt::format(" and {} more", all.size() - most);
  return text + "\n";
}

/// A line with the shares of a tick's phases in its wall time.
std::string shares(const timing::PhaseTimes& wall) {
  if (wall.ticks() == 0) return {};
  std::string text;
  for (std::size_t i = static_cast<std::size_t>(Phase::encode); i < timing::phase_count; ++i) {
    if (wall.seconds[i] == 0) continue;
    text += fmt::format("{}{} {:.1f} %", text.empty() ? "  of a tick: " : ", ",
                        timing::phase_names[i], 100 * wall.seconds[i] / wall.ticks());
  }
  return text + "\n";
}

/// The time of the start-up, and of the parts of the ticks [s].
nlohmann::ordered_json parts(const timing::PhaseTimes& wall) {
  return {{"startup", wall[Phase::startup]},
          {"physics", wall.physics()},
          {"exchange", wall.exchange()},
          {"recording", wall[Phase::recording]},
          {"pacing", wall[Phase::pacing]}};
}

/// The time of each phase of a tick [s].
nlohmann::ordered_json phases(const timing::PhaseTimes& wall) {
  nlohmann::ordered_json json;
  for (std::size_t i = static_cast<std::size_t>(Phase::encode); i < timing::phase_count; ++i)
    json[timing::phase_names[i]] = wall.seconds[i];
  return json;
}

bool is_by_controller(Ending ending) {
  return ending == Ending::controller_vanished || ending == Ending::failed_fast ||
         ending == Ending::deadline_missed;
}

std::string_view heading_of(Ending ending) {
  if (is_by_controller(ending)) return "ended early";
  return ending == Ending::shut_down ? "shut down" : to_string(ending);
}

}  // namespace

std::string to_text(const Summary& summary) {
  std::string text = fmt::format(
      "{}: {} ticks, {:.3f} s simulated in {:.3f} s: real-time factor {:.2f}, {:.0f} ticks/s\n",
      heading_of(summary.ending), summary.ticks, summary.simulated_s, summary.wall.ticks(),
      ratio(summary.simulated_s, summary.wall.ticks()),
      ratio(static_cast<double>(summary.ticks), summary.wall.ticks()));
  text +=
      fmt::format("  wall time: physics {:.3f} s, exchange {:.3f} s, recording {:.3f} s",
                  summary.wall.physics(), summary.wall.exchange(), summary.wall[Phase::recording]);
  if (summary.wall[Phase::pacing] > 0) {
    text += fmt::format(", pacing {:.3f} s ({} ticks late)", summary.wall[Phase::pacing],
                        summary.late_ticks);
  }
  text += fmt::format("; before it, start-up {:.3f} s\n", summary.wall[Phase::startup]);
  text += shares(summary.wall);
  if (!summary.shutdown_reason.empty()) {
    text +=
        fmt::format("  shut down by a supervisor: {}\n", text::indented(summary.shutdown_reason));
  }
  if (summary.result) {
    const std::string& result = summary.result->text;
    text += fmt::format("  director '{}' ended the run{}{}\n", summary.result->director,
                        result.empty() ? "" : ": ", text::indented(result));
  }
  for (const auto& each : summary.missed) {
    text += fmt::format("  controller '{}' missed its deadline at {} tick{}\n", each.controller,
                        each.ticks, each.ticks == 1 ? "" : "s");
  }
  if (!summary.failures.empty()) text += failed(summary.failures);
  if (!summary.departures.empty()) text += departed(summary.departures);
  if (!summary.recording_failure.empty())
    text += fmt::format("  not recorded in whole: {}\n", summary.recording_failure);
  for (const auto& each : summary.dropped) text += fmt::format("  {}\n", each);
  if (const auto& solver = summary.solver; solver.not_converged > 0) {
    text += fmt::format(
        "  the solver did not converge in {} of {} islands; the worst residual is {:.2g} m/s or "
        "rad/s\n",
        solver.not_converged, solver.islands, solver.worst_residual);
  }
  text += metrics(summary.metrics);
  text += fmt::format("  seed {}, hash {}", summary.seed, math::to_hex(summary.hash));
  return text;
}

std::string to_json(const Summary& summary) {
  auto failures = nlohmann::ordered_json::array();
  for (const auto& failure : summary.failures) {
    nlohmann::ordered_json entry;
    if (failure.director.empty()) {
      entry = {{"robot", failure.robot}, {"controller", failure.controller}};
    } else {
      entry = {{"director", failure.director}};
    }
    entry["tick"] = failure.tick;
    entry["message"] = failure.message;
    failures.push_back(std::move(entry));
  }
  auto departures = nlohmann::ordered_json::array();
  for (const auto& each : summary.departures) {
    departures.push_back(
        {{"robot", each.robot}, {"controller", each.controller}, {"tick", each.tick}});
  }
  auto missed = nlohmann::ordered_json::array();
  for (const auto& each : summary.missed) {
    missed.push_back({{"controller", each.controller}, {"ticks", each.ticks}});
  }
  nlohmann::ordered_json json{
      {"scene", summary.scene},
      {"ending", to_string(summary.ending)},
      {"ticks", summary.ticks},
      {"simulated_s", summary.simulated_s},
      {"wall_s", summary.wall.ticks()},
      {"real_time_factor", ratio(summary.simulated_s, summary.wall.ticks())},
      {"ticks_per_s", ratio(static_cast<double>(summary.ticks), summary.wall.ticks())},
      {"wall_time_s", parts(summary.wall)},
      {"phases_s", phases(summary.wall)},
      {"late_ticks", summary.late_ticks},
      {"seed", summary.seed},
      {"hash", math::to_hex(summary.hash)},
      {"robots", summary.robots},
      {"failures", failures},
      {"left", departures},
      {"missed_deadlines", missed},
      {"dropped", summary.dropped},
      {"vanished", summary.vanished}};
  json["metrics"] = summary.metrics;
  if (!summary.shutdown_reason.empty()) json["shutdown_reason"] = summary.shutdown_reason;
  if (!summary.recording_failure.empty()) json["recording_failure"] = summary.recording_failure;
  if (summary.result) {
    json["director"] = summary.result->director;
    json["result"] = summary.result->text;
  }
  if (summary.solver.islands > 0) {
    json["solver"]["islands"] = summary.solver.islands;
    json["solver"]["not_converged"] = summary.solver.not_converged;
    json["solver"]["worst_residual"] = summary.solver.worst_residual;
  }
  return json_text(json);
}

int exit_code_of(const Summary& summary) {
  if (summary.ending == Ending::interrupted || summary.ending == Ending::forced) {
    return exit_code::interrupted;
  }
  const bool has_drops = summary.drops_are_failures && !summary.dropped.empty();
  if (is_by_controller(summary.ending) || !summary.failures.empty() || has_drops) {
    return exit_code::controller_failed;
  }
  if (!summary.recording_failure.empty()) return exit_code::fault;
  return exit_code::finished;
}

}  // namespace ziggurat::reports
