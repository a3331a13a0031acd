// SPDX-License-Identifier: MIT
// A report card as JSON, CSV and a picture.

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "reports/plot.h"
#include "reports/report_card.h"
#include "text/quoting.h"

namespace ziggurat::reports {
namespace {

using network::Reaction;
using nlohmann::ordered_json;

ordered_json to_json(const network::Disturbance& disturbance, std::uint64_t lost) {
  return {{"latency_s", static_cast<double>(disturbance.latency.count()) * 1e-9},
          {"jitter_s", static_cast<double>(disturbance.jitter.count()) * 1e-9},
          {"loss", disturbance.loss},
          {"lost", lost}};
}

ordered_json to_json(const Percentiles& p) {
  return {{"p50", p.p50}, {"p90", p.p90}, {"p99", p.p99}, {"p99.9", p.p999}, {"max", p.max}};
}

const char* to_string(Reaction::Kind kind) {
  switch (kind) {
    case Reaction::Kind::in_time:
      return "in_time";
    case Reaction::Kind::late:
      return "late";
    case Reaction::Kind::unanswered:
      return "unanswered";
  }
  return "";
}

ordered_json to_json(const ReportCard& card, const ControllerCard& controller) {
  const Statistics& found = controller.statistics;
  auto deadlines = ordered_json::array();
  for (const auto& policy : controller.deadlines) deadlines.push_back(to_text(policy));
  auto worst = ordered_json::array();
  for (const Reaction& one : found.worst) {
    worst.push_back(
        {{"tick", one.tick}, {"wall_s", one.seconds}, {"outcome", to_string(one.kind)}});
  }
  auto histogram = ordered_json::array();
  for (std::size_t bin = 0; bin < bins::count; ++bin) {
    if (found.histogram[bin] == 0) continue;
    histogram.push_back({{"from_s", bins::begin_of(bin)}, {"count", found.histogram[bin]}});
  }
  auto gate = ordered_json::array();
  for (const Condition& condition : card.gate) {
    gate.push_back({{"condition", condition.text},
                    {"measured", measured(card, controller, condition)},
                    {"met", meets(card, controller, condition)}});
  }
  return {
      {"controller", controller.controller},
      {"deadlines", deadlines},
      {"observations", found.count()},
      {"answers", found.in_time + found.late},
      {"in_time", found.in_time},
      {"late", found.late},
      {"unanswered", found.unanswered},
      {"ticks", found.ticks},
      {"misses", found.misses},
      {"longest_run_of_misses", found.longest_run},
      {"injected",
       {{"observations", to_json(controller.injected.observations, controller.lost.observations)},
        {"commands", to_json(controller.injected.commands, controller.lost.commands)}}},
      {"wall_latency_s", to_json(found.wall_s)},
      {"wall_jitter_s", found.jitter_s},
      {"worst", worst},
      {"histogram", histogram},
      {"gate", gate}};
}

std::string robot_of(const ReportCard& card, const Reaction& one) {
  // A robot that was spawned is forgotten after a reset.
  return one.robot < card.robots.size() ? text::csv_field(card.robots[one.robot])
                                        : fmt::format("robot {}", one.robot);
}

/// When the tick of a reaction began after its moment; none if it was not paced, as tick 0.
const TickStart* start_of(const ReportCard& card, const Reaction& one) {
  const auto key = [](const auto& each) { return std::pair(each.world, each.tick); };
  const auto found = std::ranges::lower_bound(card.starts, key(one), {}, key);
  return found != card.starts.end() && key(*found) == key(one) ? &*found : nullptr;
}

/// The histogram as steps: each bin from its begin to just before the next.
Curve curve_of(const Statistics& found, std::vector<double>& x) {
  Curve curve{"observations per bin", "#2563a8", false, {}};
  const auto is_used = [](std::uint64_t count) { return count > 0; };
  const auto begin = std::ranges::find_if(found.histogram, is_used);
  auto end = found.histogram.end();
  while (end != begin && !is_used(*(end - 1))) --end;
  for (auto bin = begin; bin != end; ++bin) {
    const auto index = static_cast<std::size_t>(bin - found.histogram.begin());
    x.push_back(bins::begin_of(index) * 1e3);
    x.push_back(bins::begin_of(index + 1) * 0.999e3);
    curve.y.insert(curve.y.end(), 2, static_cast<double>(*bin));
  }
  return curve;
}

Panel panel_of(const ReportCard& card, const ControllerCard& controller) {
  const Statistics& found = controller.statistics;
  Panel panel{"controller " + controller.controller,
              "from observation to command [ms]",
              "observations",
              {},
              {}};
  if (controller.injected.any()) panel.title += ", injected: " + to_text(controller.injected);
  panel.curves.push_back(curve_of(found, panel.x));
  for (const auto& policy : controller.deadlines) {
    if (policy.wall_deadline_ms == 0) continue;
    panel.marks.push_back(
        {static_cast<double>(policy.wall_deadline_ms), "deadline " + to_text(policy), "#c2410c"});
  }
  panel.notes.push_back(
      {fmt::format("{} in time, {} late, {} never; at most {} misses in a row", found.in_time,
                   found.late, found.unanswered, found.longest_run),
       "black"});
  for (const Condition& condition : card.gate) {
    const bool is_met = meets(card, controller, condition);
    panel.notes.push_back({(is_met ? "met: " : "MISSED: ") + to_text(card, controller, condition),
                           is_met ? "#15803d" : "#b91c1c"});
  }
  return panel;
}

}  // namespace

std::string to_json(const ReportCard& card) {
  auto controllers = ordered_json::array();
  for (const ControllerCard& each : card.controllers) controllers.push_back(to_json(card, each));
  const ordered_json json{{"scene", card.scene},
                          {"seed", card.seed},
                          {"date", card.date},
                          {"period_s", card.period_s},
                          {"ticks", card.ticks},
                          {"warm_up", card.warm_up},
                          {"late_ticks", card.late_starts},
                          {"wall_start_lateness_s", to_json(card.start_s)},
                          {"controllers", controllers},
                          {"passed", passes(card)}};
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::string to_csv(const ReportCard& card) {
  std::string text =
      "world,tick,start_lateness_s,warm_up,controller,robot,outcome,wall_latency_s\n";
  std::vector<std::pair<const Reaction*, const ControllerCard*>> lines;
  for (const ControllerCard& controller : card.controllers) {
    for (const Reaction& one : controller.reactions) lines.emplace_back(&one, &controller);
  }
  std::ranges::stable_sort(
      lines, {}, [](const auto& line) { return std::pair(line.first->world, line.first->tick); });
  for (const auto& [one, controller] : lines) {
    const TickStart* start = start_of(card, *one);
    text += fmt::format("{},{},{},{},{},{},{},{:.9f}\n", one->world, one->tick,
                        start == nullptr ? "" : fmt::format("{:.9f}", start->late_s),
                        one->tick < card.warm_up ? 1 : 0, text::csv_field(controller->controller),
                        robot_of(card, *one), to_string(one->kind), one->seconds);
  }
  return text;
}

std::string to_svg(const ReportCard& card) {
  std::vector<Panel> panels;
  for (const ControllerCard& controller : card.controllers) {
    if (controller.statistics.count() > 0) panels.push_back(panel_of(card, controller));
  }
  std::string title = "How controllers kept up";
  if (!card.gate.empty()) title += passes(card) ? ": gate met" : ": gate NOT met";
  std::string details = fmt::format("{}, seed {}, {}", card.scene, card.seed, card.date);
  if (card.period_s > 0) details += fmt::format(", period {:g} ms", card.period_s * 1e3);
  if (card.warm_up > 0) details += fmt::format(", without the first {} ticks", card.warm_up);
  return to_svg(title + "\n" + details, panels);
}

}  // namespace ziggurat::reports
