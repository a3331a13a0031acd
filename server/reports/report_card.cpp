#include "reports/report_card.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "reports/plot.h"

namespace ziggurat::reports {
namespace {

using network::Latencies;

constexpr std::size_t bar_length = 40;  // characters

Performance performance_of(const ReportCard& card, const ControllerCard& controller) {
  const Latencies& times = controller.latencies;
  Performance performance;
  performance.p50 = times.percentile(0.5);
  performance.p90 = times.percentile(0.9);
  performance.p99 = times.percentile(0.99);
  performance.p999 = times.percentile(0.999);
  performance.max = times.max();
  performance.misses = static_cast<double>(controller.misses);
  performance.late = static_cast<double>(card.late_ticks);
  performance.ticks = static_cast<double>(card.ticks);
  return performance;
}

/// The histogram as text. Five bins, a quarter of a decade, make one line.
std::string bars(const Latencies& times) {
  constexpr std::size_t together = 5;
  std::array<std::uint64_t, Latencies::bins / together> sums{};
  for (std::size_t bin = 0; bin < Latencies::bins; ++bin) {
    sums[bin / together] += times.histogram()[bin];
  }
  const std::uint64_t most = *std::ranges::max_element(sums);
  std::string text;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (sums[i] == 0) continue;
    const auto length = (sums[i] * bar_length + most - 1) / most;
    text +=
        fmt::format("\n    from {:>8.3f} ms  {:>9}  {}", Latencies::begin_of(i * together) * 1e3,
                    sums[i], std::string(static_cast<std::size_t>(length), '#'));
  }
  return text;
}

std::string shown(const Condition& condition, double value) {
  if (condition.is_share) return fmt::format("{:.3g} %", value * 100);
  if (condition.subject < Condition::Subject::misses) return fmt::format("{:.3g} ms", value * 1e3);
  return fmt::format("{:g}", value);
}

std::string conditions(const ReportCard& card, const ControllerCard& controller) {
  std::string text;
  const Performance performance = performance_of(card, controller);
  for (const Condition& condition : card.gate) {
    text += fmt::format("\n    {}  {}: {}", meets(card, controller, condition) ? "met " : "MISSED",
                        condition.text, shown(condition, measured(condition, performance)));
  }
  return text;
}

std::string injected(const ControllerCard& controller) {
  if (!controller.injected.any()) return {};
  return fmt::format("\n    injected: {}; {} observations and {} commands were lost",
                     to_text(controller.injected), controller.lost.observations,
                     controller.lost.commands);
}

nlohmann::ordered_json to_json(const network::Disturbance& disturbance, std::uint64_t lost) {
  return {{"latency_s", static_cast<double>(disturbance.latency.count()) * 1e-9},
          {"jitter_s", static_cast<double>(disturbance.jitter.count()) * 1e-9},
          {"loss", disturbance.loss},
          {"lost", lost}};
}

std::string to_text(const network::Disturbance& disturbance) {
  const auto ms = [](std::chrono::nanoseconds time) {
    return static_cast<double>(time.count()) * 1e-6;
  };
  std::string text;
  if (disturbance.latency.count() > 0) text = fmt::format("{:g} ms", ms(disturbance.latency));
  if (disturbance.jitter.count() > 0) text += fmt::format(" ± {:g} ms", ms(disturbance.jitter));
  if (disturbance.loss == 0) return text;
  return text + fmt::format("{}{:g} % lost", text.empty() ? "" : ", ", disturbance.loss * 100);
}

}  // namespace

bool meets(const ReportCard& card, const ControllerCard& controller, const Condition& condition) {
  const bool is_time = condition.subject < Condition::Subject::misses;
  if (is_time && controller.latencies.count() == 0) return false;
  return measured(condition, performance_of(card, controller)) < condition.limit;
}

bool passes(const ReportCard& card) {
  return std::ranges::all_of(card.controllers, [&](const ControllerCard& controller) {
    return std::ranges::all_of(
        card.gate, [&](const Condition& condition) { return meets(card, controller, condition); });
  });
}

std::string to_text(const network::Injection& injection) {
  if (injection.observations == injection.commands) {
    return "each way " + to_text(injection.observations);
  }
  std::string text;
  if (injection.observations.any()) text = "observations " + to_text(injection.observations);
  if (!injection.commands.any()) return text;
  return text + (text.empty() ? "" : "; ") + "commands " + to_text(injection.commands);
}

std::string to_text(const ReportCard& card) {
  std::string text =
      fmt::format("report card: {} ticks, {} of them late", card.ticks, card.late_ticks);
  for (const ControllerCard& controller : card.controllers) {
    const Performance p = performance_of(card, controller);
    text += fmt::format(
        "\n  controller '{}': {} answers in time or late, {} misses\n"
        "    p50 {:.3f} ms, p90 {:.3f} ms, p99 {:.3f} ms, p99.9 {:.3f} ms, max {:.3f} ms",
        controller.controller, controller.latencies.count(), controller.misses, p.p50 * 1e3,
        p.p90 * 1e3, p.p99 * 1e3, p.p999 * 1e3, p.max * 1e3);
    const auto worst = controller.latencies.worst();
    for (std::size_t i = 0; i < worst.size(); ++i) {
      text += fmt::format("{}{:.3f} ms at tick {}", i == 0 ? "\n    worst: " : ", ",
                          worst[i].seconds * 1e3, worst[i].tick);
    }
    text += injected(controller) + bars(controller.latencies) + conditions(card, controller);
  }
  if (!card.gate.empty()) text += passes(card) ? "\n  gate: met" : "\n  gate: not met";
  return text;
}

std::string to_json(const ReportCard& card) {
  auto controllers = nlohmann::ordered_json::array();
  for (const ControllerCard& controller : card.controllers) {
    const Performance p = performance_of(card, controller);
    auto worst = nlohmann::ordered_json::array();
    for (const auto& each : controller.latencies.worst()) {
      worst.push_back({{"tick", each.tick}, {"wall_s", each.seconds}});
    }
    auto histogram = nlohmann::ordered_json::array();
    for (std::size_t bin = 0; bin < Latencies::bins; ++bin) {
      if (controller.latencies.histogram()[bin] == 0) continue;
      histogram.push_back(
          {{"from_s", Latencies::begin_of(bin)}, {"count", controller.latencies.histogram()[bin]}});
    }
    auto gate = nlohmann::ordered_json::array();
    for (const Condition& condition : card.gate) {
      gate.push_back({{"condition", condition.text},
                      {"measured", measured(condition, p)},
                      {"met", meets(card, controller, condition)}});
    }
    controllers.push_back(
        {{"controller", controller.controller},
         {"answers", controller.latencies.count()},
         {"misses", controller.misses},
         {"injected",
          {{"observations",
            to_json(controller.injected.observations, controller.lost.observations)},
           {"commands", to_json(controller.injected.commands, controller.lost.commands)}}},
         {"wall_latency_s",
          {{"p50", p.p50}, {"p90", p.p90}, {"p99", p.p99}, {"p99.9", p.p999}, {"max", p.max}}},
         {"worst", worst},
         {"histogram", histogram},
         {"gate", gate}});
  }
  const nlohmann::ordered_json json{{"ticks", card.ticks},
                                    {"late_ticks", card.late_ticks},
                                    {"controllers", controllers},
                                    {"passed", passes(card)}};
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string to_svg(const ReportCard& card) {
  std::vector<Panel> panels;
  for (const ControllerCard& controller : card.controllers) {
    Panel panel{"controller " + controller.controller,
                "from observation to command [ms]",
                "answers",
                {},
                {}};
    if (controller.injected.any()) panel.title += ", injected: " + to_text(controller.injected);
    Curve curve{"answers per bin", "#2563a8", false, {}};
    const auto& histogram = controller.latencies.histogram();
    const auto is_used = [](std::uint64_t count) { return count > 0; };
    const auto first = std::ranges::find_if(histogram, is_used);
    if (first == histogram.end()) continue;
    auto last = histogram.end();
    while (!is_used(*(last - 1))) --last;
    for (auto bin = first; bin != last; ++bin) {
      const auto index = static_cast<std::size_t>(bin - histogram.begin());
      // Steps: each bin from its begin to just before the next.
      panel.x.push_back(Latencies::begin_of(index) * 1e3);
      panel.x.push_back(Latencies::begin_of(index + 1) * 0.999e3);
      curve.y.insert(curve.y.end(), 2, static_cast<double>(*bin));
    }
    panel.curves.push_back(std::move(curve));
    panels.push_back(std::move(panel));
  }
  return to_svg("How controllers kept up", panels);
}

}  // namespace ziggurat::reports
