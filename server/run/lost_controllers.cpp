// SPDX-License-Identifier: MIT
#include "run/lost_controllers.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "run/absent.h"

namespace ziggurat::run {
namespace {

using Membership = network::RobotStatus::Membership;

/// Messages of a process that ended may arrive as late as that.
constexpr std::chrono::milliseconds last_messages{250};

/// Whether this process is one to start again. Lua processes have robots of several controllers:
/// the most that one of these may counts. Robots that came later have sessions of their own, and
/// are not resumed.
/// @param restarts  per controller; empty: none
bool may_restart(const processes::ControllerProcess& process, const std::vector<unsigned>& restarts,
                 const world::Layout& layout) {
  if (process.pipe || restarts.empty()) return false;
  return std::ranges::any_of(process.robots, [&](std::size_t robot) {
    return process.restarts < restarts[layout.robots[robot].controller];
  });
}

/// The robots of a program that has driven them and ended with exit code 0, without a Leave: they
/// leave as if it had sent one. Empty if it is none.
std::vector<std::size_t> left_by(const processes::ControllerProcess& ended,
                                 const std::vector<network::RobotStatus>& status) {
  std::vector<std::size_t> robots;
  const bool has_begun =
      std::ranges::all_of(ended.robots, [&](std::size_t robot) { return status[robot].was_held; });
  if (!ended.process.ended_well() || !has_begun) return robots;
  std::ranges::copy_if(ended.robots, std::back_inserter(robots), [&](std::size_t robot) {
    return status[robot].membership == Membership::free;
  });
  return robots;
}

/// Whether all robots of a process that has ended are driven by others, who took them over.
bool is_replaced(const processes::ControllerProcess& ended,
                 const std::vector<network::RobotStatus>& status) {
  return !ended.robots.empty() && std::ranges::all_of(ended.robots, [&](std::size_t robot) {
    return status[robot].membership == Membership::held;
  });
}

}  // namespace

/// Whether an ended process leaves something undone: robots that the run can't go on without, or
/// that it would have if it was started again.
bool LostControllers::is_missed(const processes::ControllerProcess& process,
                                const std::vector<network::RobotStatus>& status,
                                const std::vector<std::string>& free_directors,
                                bool gathered) const {
  if (std::ranges::find(free_directors, process.director) != free_directors.end()) return true;
  // One that was ended from outside took leave perhaps; its own failures are reported already.
  const bool was_ended = !process.process.ended_well() && !peers_.has_failure(process.robots);
  return std::ranges::any_of(process.robots, [&](std::size_t robot) {
    const bool is_held = status[robot].membership != Membership::gone;
    return (is_held || was_ended) &&
           (is_required(status[robot], gathered) ||
            (is_held && may_restart(process, settings_.restarts, world_.simulation.layout())));
  });
}

// Waits a little before it decides, for each process by itself: the last messages of one that
// ended, which may release its robots, may still arrive; and a lost connection may be that of a
// process whose end is not known yet.
std::optional<std::string> LostControllers::look(const Moment& moment) {
  child_ended_ = false;
  const auto now = clock::now();
  const auto status = server_.status();
  const auto directors = directors_.status();
  auto free_directors = absent_directors(directors, moment.gathered);
  const auto ended = controllers_.ended([&](const auto& process) {
    return is_missed(process, status, free_directors, moment.gathered);
  });
  auto lost = moment.gathered ? absent_robots(status, true) : std::vector<std::size_t>();
  std::erase_if(restarted_,
                [&](std::size_t robot) { return status[robot].membership != Membership::free; });
  std::erase_if(lost, [&](std::size_t robot) {  // those whose controller is still to come
    return !status[robot].was_held || std::ranges::find(restarted_, robot) != restarted_.end();
  });
  std::erase_if(free_directors, [&](const std::string& id) {  // those that are still to come
    return !std::ranges::find(directors, id, &network::DirectorStatus::id)->was_held;
  });
  is_early_ = false;
  for (processes::ControllerProcess* each : ended) {
    if (!each->missed_since) each->missed_since = now;
    if (now - *each->missed_since >= last_messages) return settle(*each, status, moment);
    is_early_ = true;
    std::erase_if(lost, [&](std::size_t robot) {
      return std::ranges::find(each->robots, robot) != each->robots.end();
    });
    std::erase(free_directors, each->director);
  }
  return disconnected(lost, free_directors, moment.tick, now);
}

/// The sentence on lost connections, once they have been lost for some time.
std::optional<std::string> LostControllers::disconnected(const std::vector<std::size_t>& robots,
                                                         const std::vector<std::string>& directors,
                                                         std::uint64_t tick,
                                                         clock::time_point now) {
  if (robots.empty() && directors.empty()) {
    missed_since_.reset();
    return std::nullopt;
  }
  if (!missed_since_) missed_since_ = now;
  if (now - *missed_since_ < last_messages) return std::nullopt;
  if (!directors.empty()) {
    return fmt::format("director '{}' disconnected at tick {}", directors.front(), tick);
  }
  return fmt::format("the controller of {} disconnected at tick {}", by_controller(world_, robots),
                     tick);
}

/// Handles an ended process. Others have its robots, it has left by itself, it is started again, or
/// the run ends.
std::optional<std::string> LostControllers::settle(processes::ControllerProcess& ended,
                                                   const std::vector<network::RobotStatus>& status,
                                                   const Moment& moment) {
  child_ended_ = true;  // another may have ended with it
  const auto left = moment.gathered ? left_by(ended, status) : std::vector<std::size_t>();
  if (!left.empty()) {
    network::Report report;
    for (const std::size_t robot : left) {
      if (moment.tick != settings_.last_tick) report.departures.push_back({robot, moment.tick});
    }
    server_.remove_robots(left);
    peers_.take(std::move(report), moment.tick);
  }
  ended.is_settled = !left.empty() || is_replaced(ended, status);
  if (ended.is_settled) return std::nullopt;
  const std::string when =
      moment.gathered ? fmt::format("at tick {}", moment.tick) : "before the first tick";
  std::string end = processes::describe(
      ended, fmt::format("{} {}", ended.process.how_it_ended(), when), world_.simulation.layout());
  if (const auto script = processes::busy_script(ended)) {  // of many robots one may be the reason
    end += fmt::format("; it ran the script of {}: {}", script->robot, script->place);
  }
  if (restart(ended, end)) return std::nullopt;
  return end;
}

/// Starts an ended process again, if the options ask for it and one of its robots is still in the
/// run.
/// @param end  the sentence on its end, which is a notice then
bool LostControllers::restart(const processes::ControllerProcess& ended, const std::string& end) {
  const auto status = server_.status();
  const auto robot = std::ranges::find_if(
      ended.robots, [&](std::size_t each) { return status[each].membership != Membership::gone; });
  if (robot == ended.robots.end() ||
      !may_restart(ended, settings_.restarts, world_.simulation.layout()))
    return false;
  const auto& started = controllers_.restart(ended, status[*robot].token);
  peers_.notice(fmt::format("{}; started again (restart {}) as process {}", end, started.restarts,
                            started.process.id()));
  restarted_.insert(restarted_.end(), started.robots.begin(), started.robots.end());
  return true;
}

}  // namespace ziggurat::run
