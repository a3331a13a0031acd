// SPDX-License-Identifier: MIT
#include "run/peer_reports.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "processes/controllers.h"
#include "text/printable.h"

namespace ziggurat::run {
namespace {

constexpr std::size_t behind_robots = static_cast<std::size_t>(-1);  // lines of directors

}  // namespace

void PeerReports::notice(const std::string& text) {
  console_.notice(text);
  tell_(channels::Severity::warning, "ziggurat", text);
}

void PeerReports::take(network::Report report, std::uint64_t tick, network::Notices::Time now) {
  for (const auto& text : report.dropped) notice(text);
  take_departures(report.departures, now);
  for (const auto& text : report.notices) notice(text);
  const auto& robots = world_.simulation.layout().robots;
  for (wire::LogLine& line : report.log) log_.push_back({std::move(line), robots[line.robot].id});
  for (network::DirectorLine& line : report.log_of_directors) {
    log_.push_back({{behind_robots, line.error, std::move(line.text)}, std::move(line.director)});
  }
  for (auto& failure : report.failed_directors) {
    print_log(tick);
    const auto text = fmt::format("director '{}' failed at tick {}: {}", failure.director,
                                  failure.tick, text::indented(failure.message));
    console_.fault(text);
    tell_(channels::Severity::error, failure.director, text);
    failures_.push_back(
        {std::nullopt, {{}, {}, failure.tick, std::move(failure.message), failure.director}});
  }
  for (auto& failure : report.failures) {
    const auto& robot = robots[failure.robot];
    const auto& controller = world_.scene.controllers[robot.controller].id;
    print_log(tick);
    const auto text = fmt::format("robot {} (controller '{}') failed at tick {}: {}", robot.id,
                                  controller, failure.tick, text::indented(failure.message));
    console_.fault(text);
    tell_(channels::Severity::error, robot.id, text);
    failures_.push_back(
        {failure.robot, {robot.id, controller, failure.tick, std::move(failure.message)}});
  }
}

void PeerReports::take_departures(const std::vector<network::Departure>& departures,
                                  network::Notices::Time now) {
  const world::Layout& layout = world_.simulation.layout();
  std::map<std::pair<std::size_t, std::uint64_t>, std::vector<std::size_t>>
      groups;  // by controller and tick
  for (const network::Departure& each : departures) {
    const auto& robot = layout.robots[each.robot];
    groups[{robot.controller, each.tick}].push_back(each.robot);
    departures_.push_back({robot.id, world_.scene.controllers[robot.controller].id, each.tick});
  }
  for (const auto& [group, robots] : groups) {
    of_departures_.add(
        fmt::format("{} (controller '{}') left at tick {}: {} controller ended, and the run goes "
                    "on without it",
                    processes::names_of(robots, layout), world_.scene.controllers[group.first].id,
                    group.second, robots.size() == 1 ? "its" : "their"),
        now);
  }
  of_departures_.tell_last(now);
  for (const auto& text : of_departures_.take()) notice(text);
}

void PeerReports::print_log(std::uint64_t tick) {
  std::ranges::stable_sort(log_, {},
                           [](const Line& each) { return std::tie(each.line.robot, each.robot); });
  for (const auto& [line, robot] : log_) {
    console_.log_line(tick, robot, line.text, line.error);
    tell_(line.error ? channels::Severity::error : channels::Severity::info, robot, line.text);
  }
  log_.clear();
  console_.offer();
}

void PeerReports::forget_spawned() {
  const auto& robots = world_.simulation.layout().robots;
  for (auto& [robot, failure] : failures_) {
    if (robot && (*robot >= robots.size() || robots[*robot].id != failure.robot)) robot.reset();
  }
  std::size_t forgotten = 0;
  std::erase_if(failures_,
                [&](const auto& failure) { return !failure.first && ++forgotten > most_kept; });
  if (departures_.size() > most_kept) departures_.resize(most_kept);
}

bool PeerReports::has_failure(std::span<const std::size_t> robots) const {
  return std::ranges::any_of(failures_, [&](const auto& failure) {
    return failure.first && std::ranges::find(robots, *failure.first) != robots.end();
  });
}

std::vector<reports::Summary::Failure> PeerReports::failures() const {
  auto sorted = failures_;
  std::ranges::sort(sorted, {},
                    [](const auto& each) { return std::tuple(each.second.tick, each.first); });
  std::vector<reports::Summary::Failure> result;
  for (auto& [robot, failure] : sorted) result.push_back(std::move(failure));
  return result;
}

}  // namespace ziggurat::run
