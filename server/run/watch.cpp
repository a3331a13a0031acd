#include "run/watch.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <poll.h>

#include <algorithm>
#include <utility>

namespace ziggurat::run {
namespace {

using reports::Ending;
using std::chrono::milliseconds;
using Membership = network::RobotStatus::Membership;

constexpr milliseconds usual_wait{200};     // between two looks while no message arrives
constexpr milliseconds short_wait{20};      // while a controller may have vanished
constexpr milliseconds last_messages{250};  // of a process that ended may arrive as late as that
constexpr milliseconds noticeable{500};     // a wait that the progress line names
constexpr milliseconds long_wait{5000};     // a wait that gets a line of its own

/// Directors without session that the run can't go on without.
/// @param gathered  every robot and director was there
std::vector<std::string> lost_directors(const std::vector<network::DirectorStatus>& directors,
                                        bool gathered) {
  std::vector<std::string> lost;
  for (const network::DirectorStatus& each : directors) {
    const bool is_gone = !each.is_held && !each.has_left;
    if (is_gone && (!gathered || each.waits)) lost.push_back(each.id);
  }
  return lost;
}

/// Whether a place names a line, `FILE:LINE`.
bool has_line(const std::string& place) {
  const auto colon = place.rfind(':');
  return colon != std::string::npos &&
         place.find_first_not_of("0123456789", colon + 1) == std::string::npos;
}

/// "director 'judge'", for each that the tick waits for.
std::vector<std::string> awaited_of(const std::vector<network::DirectorStatus>& directors) {
  std::vector<std::string> names;
  for (const network::DirectorStatus& each : directors) {
    if (each.is_awaited) names.push_back(fmt::format("director '{}'", each.id));
  }
  return names;
}

// "r0, r1 (controller 'swing'), r7 (controller 'lift')"
std::string by_controller(const supervision::World& world, const std::vector<std::size_t>& robots) {
  const world::Layout& layout = world.simulation.layout();
  std::string text;
  for (std::size_t c = 0; c < world.scene.controllers.size(); ++c) {
    std::vector<std::size_t> controlled;
    std::ranges::copy_if(robots, std::back_inserter(controlled),
                         [&](std::size_t robot) { return layout.robots[robot].controller == c; });
    if (controlled.empty()) continue;
    text += fmt::format("{}{} (controller '{}')", text.empty() ? "" : ", ",
                        processes::names_of(controlled, layout), world.scene.controllers[c].id);
  }
  return text;
}

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

/// Whether the run cannot continue without the robot's controller: before the first tick always,
/// later if its deadline policy is to wait.
bool is_required(const network::RobotStatus& robot, bool gathered) {
  return !gathered || robot.deadline.action == scene::DeadlineAction::wait;
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

Watch::Watch(const Settings& settings, const supervision::World& world, network::Server& server,
             processes::Controllers& controllers, supervision::Supervision& supervision,
             processes::Signals& signals, reports::Console& console, LiveView* live_view,
             TellLine tell)
    : world_(world),
      server_(server),
      directors_(server),
      controllers_(controllers),
      supervision_(supervision),
      signals_(signals),
      console_(console),
      live_view_(live_view),
      descriptors_(live_view ? std::vector{signals.descriptor(), live_view->descriptor()}
                             : std::vector{signals.descriptor()}),
      fails_fast_(settings.fail_fast),
      waits_for_clients_(settings.waits_for_clients),
      last_tick_(settings.ticks),
      restarts_(settings.restarts),
      peers_(world, console, std::move(tell)),
      progress_(console, world.simulation.tick_length(), settings.ticks) {
  if (settings.metrics.empty()) return;
  metrics_.emplace(settings.metrics, settings.insecure);
  console_.notice("metrics at " + metrics_->url());
}

std::optional<Ending> Watch::gather() {
  gathered_ = false;  // a reset may have freed robots
  const auto ending = until([&](const auto& wait) { return server_.gather(wait); });
  gathered_ = !ending;
  return ending;
}

std::optional<Ending> Watch::collect(world::Commands& commands, std::uint64_t tick) {
  tick_ = tick;
  measured_.clear();
  return until([&](const auto& wait) { return server_.collect(commands, wait, &measured_); });
}

std::optional<Ending> Watch::sleep_until(const std::function<clock::time_point()>& moment,
                                         world::Commands& commands) {
  for (;;) {
    serve();
    if (auto ending = interruption()) return ending;
    if (auto ending = supervisor_request()) return ending;
    const auto left = std::chrono::floor<milliseconds>(moment() - clock::now());
    if (left.count() <= 0) break;
    if (progress_.needs_update()) progress_.show(tick_, "");
    console_.offer();
    server_.linger(commands, {std::min(left, usual_wait), descriptors_});
    take_report();
  }
  std::this_thread::sleep_until(moment());
  return std::nullopt;
}

std::optional<Ending> Watch::wait_for_viewer(world::Commands& commands) {
  console_.notice(wait_notice());
  console_.flush();
  const auto end = clock::now() + longest_wait_for_viewer;
  return sleep_until([&] { return live_view_->is_watched() ? clock::time_point() : end; },
                     commands);
}

void Watch::show_end() {
  live_view_->end();
  std::vector<pollfd> items;
  for (const int descriptor : descriptors_) items.push_back({descriptor, POLLIN, 0});
  while (!live_view_->shutdown_requested() && signals_.take().interruptions == 0) {
    live_view_->serve();
    live_view_->update();
    ::poll(items.data(), items.size(), static_cast<int>(usual_wait.count()));
  }
}

std::optional<Ending> Watch::until(const Step& step) {
  waiting_since_ = clock::now();
  for (;;) {
    const auto outcome = step({missed_since_ || is_early_ ? short_wait : usual_wait, descriptors_});
    serve();
    take_report();
    auto ending = interruption();
    if (!ending) ending = stopped_;
    if (!ending) ending = supervisor_request();
    const bool complete = outcome == network::Outcome::complete;
    const bool may_have_lost =
        !complete || child_ended_ || missed_since_ || is_early_ || !restarted_.empty();
    if (!ending && may_have_lost) ending = lost_controller();
    if (ending || complete) {
      peers_.print_log(tick_);
      printed_.clear();
      if (progress_.needs_update()) progress_.show(tick_, "");
      return ending;
    }
    report_awaited();
  }
}

void Watch::serve() {
  if (live_view_) live_view_->serve();
  supervision_.serve();
  if (live_view_) live_view_->update();
  if (metrics_ && metrics_->needs_update()) metrics_->publish(supervision_.status());
}

std::optional<Ending> Watch::interruption() {
  const auto arrived = signals_.take();
  child_ended_ |= arrived.child;
  if (arrived.interruptions == 0) return std::nullopt;
  return arrived.interruptions > 1 ? Ending::forced : Ending::interrupted;
}

std::optional<Ending> Watch::supervisor_request() {
  if (const auto& reason = supervision_.requested_shutdown()) {
    return reason->empty() ? Ending::interrupted : Ending::shut_down;
  }
  if (supervision_.requests_restart()) return Ending::reset;
  return std::nullopt;
}

/// Whether an ended process leaves something undone: robots that the run can't go on without, or
/// that it would have if it was started again.
bool Watch::is_missed(const processes::ControllerProcess& process,
                      const std::vector<network::RobotStatus>& status,
                      const std::vector<std::string>& free_directors) const {
  if (std::ranges::find(free_directors, process.director) != free_directors.end()) return true;
  // One that was ended from outside took leave perhaps; its own failures are reported already.
  const bool was_ended = !process.process.ended_well() && !peers_.has_failure(process.robots);
  return std::ranges::any_of(process.robots, [&](std::size_t robot) {
    const bool is_held = status[robot].membership != Membership::gone;
    return (is_held || was_ended) &&
           (is_required(status[robot], gathered_) ||
            (is_held && may_restart(process, restarts_, world_.simulation.layout())));
  });
}

// Waits a little before it decides, for each process by itself: the last messages of one that
// ended, which may release its robots, may still arrive; and a lost connection may be that of a
// process whose end is not known yet.
std::optional<Ending> Watch::lost_controller() {
  child_ended_ = false;
  if (waits_for_clients_) return std::nullopt;
  const auto now = clock::now();
  const auto status = server_.status();
  const auto directors = directors_.status();
  auto free_directors = lost_directors(directors, gathered_);
  const auto ended = controllers_.ended(
      [&](const auto& process) { return is_missed(process, status, free_directors); });
  auto lost = gathered_ ? unheld_robots() : std::vector<std::size_t>();
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
    if (now - *each->missed_since >= last_messages) return settle(*each, status);
    is_early_ = true;
    std::erase_if(lost, [&](std::size_t robot) {
      return std::ranges::find(each->robots, robot) != each->robots.end();
    });
    std::erase(free_directors, each->director);
  }
  if (lost.empty() && free_directors.empty()) {
    missed_since_.reset();
    return std::nullopt;
  }
  if (!missed_since_) missed_since_ = now;
  if (now - *missed_since_ < last_messages) return std::nullopt;
  vanished_ = !free_directors.empty() ? fmt::format("director '{}' disconnected at tick {}",
                                                    free_directors.front(), tick_)
                                      : fmt::format("the controller of {} disconnected at tick {}",
                                                    by_controller(world_, lost), tick_);
  return Ending::controller_vanished;
}

/// Handles an ended process. Others have its robots, it has left by itself, it is started again, or
/// the run ends.
std::optional<Ending> Watch::settle(processes::ControllerProcess& ended,
                                    const std::vector<network::RobotStatus>& status) {
  child_ended_ = true;  // another may have ended with it
  const auto left = gathered_ ? left_by(ended, status) : std::vector<std::size_t>();
  if (!left.empty()) {
    network::Report report;
    for (const std::size_t robot : left) {
      if (tick_ != last_tick_) report.departures.push_back({robot, tick_});
    }
    server_.remove_robots(left);
    peers_.take(std::move(report), tick_);
  }
  ended.is_settled = !left.empty() || is_replaced(ended, status);
  if (ended.is_settled) return std::nullopt;
  const std::string when = gathered_ ? fmt::format("at tick {}", tick_) : "before the first tick";
  vanished_ = processes::describe(ended, fmt::format("{} {}", ended.process.how_it_ended(), when),
                                  world_.simulation.layout());
  if (const auto script = processes::busy_script(ended)) {  // of many robots one may be the reason
    vanished_ += fmt::format("; it ran the script of {}: {}", script->robot, script->place);
  }
  if (restart(ended)) return std::nullopt;
  return Ending::controller_vanished;
}

/// Starts an ended process again, if the options ask for it and one of its robots is still in the
/// run. The sentence on its end is a notice then.
bool Watch::restart(const processes::ControllerProcess& ended) {
  const auto status = server_.status();
  const auto robot = std::ranges::find_if(
      ended.robots, [&](std::size_t each) { return status[each].membership != Membership::gone; });
  if (robot == ended.robots.end() || !may_restart(ended, restarts_, world_.simulation.layout()))
    return false;
  const auto& started = controllers_.restart(ended, status[*robot].token);
  console_.notice(fmt::format("{}; started again (restart {}) as process {}",
                              std::exchange(vanished_, {}), started.restarts,
                              started.process.id()));
  restarted_.insert(restarted_.end(), started.robots.begin(), started.robots.end());
  return true;
}

void Watch::take_report() {
  auto report = server_.take_report();
  if (!report.stopped.empty()) {
    vanished_ = std::move(report.stopped);
    stopped_ = Ending::deadline_missed;
  }
  const bool has_failed = !report.failures.empty() || !report.dropped.empty();
  if (fails_fast_ && has_failed && !stopped_) {
    stopped_ = Ending::failed_fast;
    vanished_ = fmt::format("the run ends at tick {}, as --fail-fast asks", tick_);
  }
  if (tick_ == last_tick_) report.departures.clear();  // nothing is left to be done
  std::ranges::copy(report.dropped, std::back_inserter(dropped_));
  peers_.take(std::move(report), tick_);
}

std::vector<std::size_t> Watch::unheld_robots() const {
  std::vector<std::size_t> robots;
  const auto status = server_.status();
  for (std::size_t r = 0; r < status.size(); ++r) {
    if (status[r].membership == Membership::free && is_required(status[r], gathered_))
      robots.push_back(r);
  }
  return robots;
}

std::vector<std::size_t> Watch::awaited_robots() const {
  std::vector<std::size_t> robots;
  const auto status = server_.status();
  for (std::size_t r = 0; r < status.size(); ++r) {
    if (status[r].membership != Membership::gone && status[r].awaited) robots.push_back(r);
  }
  return robots;
}

// "r3: aggregate.lua:41, r7: lift.lua:12"
/// @param robots  awaited; those whose process runs the script of a robot are taken out
/// @param detail  out: of the text
std::string Watch::busy_scripts(std::vector<std::size_t>& robots, Detail& detail) const {
  std::string text, last;
  detail = Detail::robots;
  std::erase_if(robots, [&](std::size_t robot) {
    const auto script = controllers_.busy_script(robot);
    if (!script || script->place.empty()) return false;
    if (script->robot == last) return true;  // of the same process
    last = script->robot;
    detail = std::max(detail, has_line(script->place) ? Detail::lines : Detail::scripts);
    text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", script->robot, script->place);
    return true;
  });
  return text;
}

/// Prints at once that a client must connect, where no process was started for a robot. Otherwise
/// only after a long wait.
void Watch::report_awaited() {
  const auto waited = clock::now() - waiting_since_;
  const auto robots = awaited_robots();
  const auto directors = awaited_of(directors_.status());
  Detail detail = Detail::robots;
  const auto awaited = [&] {
    auto others = robots;
    const auto busy = busy_scripts(others, detail);
    auto rest = by_controller(world_, others);
    if (!directors.empty()) {
      rest += fmt::format("{}{}", rest.empty() ? "" : ", ", fmt::join(directors, ", "));
    }
    return busy.empty() || rest.empty() ? busy + rest : busy + ", " + rest;
  };
  if (progress_.needs_update()) {
    progress_.show(tick_, waited > noticeable ? awaited() : std::string());
  }
  const bool client_must_connect =
      std::ranges::any_of(unheld_robots(),
                          [&](std::size_t robot) { return !controllers_.have(robot); }) ||
      std::ranges::any_of(lost_directors(directors_.status(), gathered_),
                          [&](const auto& id) { return !controllers_.have_director(id); });
  if (!client_must_connect && waited < long_wait) return;
  auto text = by_controller(world_, robots) + fmt::format("{}", fmt::join(directors, ", "));
  const auto all = awaited();
  if (text.empty() || (text == printed_ && detail <= printed_detail_)) return;
  const auto where = client_must_connect
                         ? fmt::format(" to connect to {}", fmt::join(server_.endpoints(), " or "))
                         : std::string();
  console_.notice(fmt::format("waiting for {}{}", all, where));
  printed_ = std::move(text);
  printed_detail_ = detail;
}

}  // namespace ziggurat::run
