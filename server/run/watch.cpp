#include "run/watch.h"

#include <fmt/format.h>
#include <signal.h>

#include <algorithm>
#include <array>
#include <thread>
#include <tuple>

namespace ziggurat::run {
namespace {

using std::chrono::milliseconds;
using Membership = network::RobotStatus::Membership;

constexpr milliseconds look_around{200};  // between looks while nothing arrives
constexpr milliseconds look_closely{20};  // while a controller may have vanished
constexpr milliseconds last_words{250};   // of a process that ended: still under way to us
constexpr milliseconds noticeable{500};   // a wait that the progress line names
constexpr milliseconds long_wait{5000};   // a wait that is worth a line of its own
constexpr milliseconds farewell{2000};    // for controllers to answer the end
constexpr int most_peer_notices = 1000;   // a hostile peer shall not fill a log
constexpr int patience_ms = 1000;         // for processes to end after that

}  // namespace

Watch::Watch(const Watched& watched, double tick_length)
    : watched_(watched), progress_(watched.console, tick_length) {}

std::optional<reports::Ending> Watch::gather() {
  gathered_ = false;  // a reset may have set robots free
  const auto ending = until([&](const auto& wait) { return watched_.server.gather(wait); });
  gathered_ = !ending;
  return ending;
}

std::optional<reports::Ending> Watch::collect(world::Commands& commands, std::uint64_t tick) {
  tick_ = tick;
  return until([&](const auto& wait) { return watched_.server.collect(commands, wait); });
}

std::optional<reports::Ending> Watch::sleep_until(clock::time_point moment,
                                                  world::Commands& commands) {
  const std::array descriptors{watched_.signals.descriptor()};
  for (;;) {
    serve();
    if (auto ending = interruption()) return ending;
    if (auto ending = wish()) return ending;
    const auto left = std::chrono::floor<milliseconds>(moment - clock::now());
    if (left.count() <= 0) break;
    if (progress_.due()) progress_.show(tick_, "");
    watched_.console.flush();
    watched_.server.linger(commands, {std::min(left, look_around), descriptors});
    take_report();
  }
  std::this_thread::sleep_until(moment);
  return std::nullopt;
}

std::optional<reports::Ending> Watch::until(const Step& step) {
  waiting_since_ = clock::now();
  const std::array descriptors{watched_.signals.descriptor()};
  for (;;) {
    const auto outcome = step({suspected_since_ ? look_closely : look_around, descriptors});
    serve();
    take_report();
    auto ending = interruption();
    if (!ending && is_stopped_) ending = reports::Ending::deadline_missed;
    if (!ending) ending = wish();
    const bool complete = outcome == network::Outcome::complete;
    if (!ending && !complete) ending = disappearance();
    if (ending || complete) {
      print_log();
      said_.clear();
      if (progress_.due()) progress_.show(tick_, "");
      return ending;
    }
    say_who_is_awaited();
  }
}

// Who supervises the run, or looks at its metrics.
void Watch::serve() {
  watched_.supervision.serve();
  if (watched_.metrics != nullptr && watched_.metrics->is_due()) {
    watched_.metrics->publish(watched_.supervision.status());
  }
}

std::optional<reports::Ending> Watch::interruption() {
  const auto arrived = watched_.signals.take();
  if (arrived.interruptions == 0) return std::nullopt;
  return arrived.interruptions > 1 ? reports::Ending::forced : reports::Ending::interrupted;
}

// What a supervisor asks for that ends the wait.
std::optional<reports::Ending> Watch::wish() {
  if (watched_.supervision.shutdown_wanted()) return reports::Ending::interrupted;
  if (watched_.supervision.reset_wanted()) return reports::Ending::reset;
  return std::nullopt;
}

// A process that ended may have said before that its robots leave, and that may still be under
// way; a peer that is lost may be a process whose end we are about to hear of.
std::optional<reports::Ending> Watch::disappearance() {
  if (watched_.waits_for_ever) return std::nullopt;
  const processes::ControllerProcess* dead = nullptr;
  for (auto& process : watched_.processes) {
    if (process.process.poll() && is_awaited(process) && !dead) dead = &process;
  }
  auto lost = gathered_ ? missing_robots() : std::vector<std::size_t>();
  const auto status = watched_.server.status();
  std::erase_if(lost, [&](std::size_t robot) { return !status[robot].was_held; });  // yet to come
  if (!dead && lost.empty()) {
    suspected_since_.reset();
    return std::nullopt;
  }
  if (!suspected_since_) suspected_since_ = clock::now();
  if (clock::now() - *suspected_since_ < last_words) return std::nullopt;
  if (dead) {
    vanished_ = fmt::format("{} (process {}) {} {}; it drove {}", dead->name, dead->process.id(),
                            dead->process.how_it_ended(),
                            gathered_ ? fmt::format("at tick {}", tick_) : "before the first tick",
                            processes::names_of(dead->robots, watched_.layout));
  } else {
    vanished_ =
        fmt::format("the controller of {} went away at tick {}", by_controller(lost), tick_);
  }
  return reports::Ending::controller_vanished;
}

// Lines wait for the end of their tick: then their order depends on nobody's speed.
void Watch::take_report() {
  auto report = watched_.server.take_report();
  if (!report.stopped.empty()) {
    vanished_ = std::move(report.stopped);
    is_stopped_ = true;
  }
  for (const auto& notice : report.dropped) watched_.console.notice(notice);
  for (const auto& notice : report.notices) {
    if (++peer_notices_ <= most_peer_notices) watched_.console.notice(notice);
    if (peer_notices_ == most_peer_notices) watched_.console.notice("no more is said of peers");
  }
  std::ranges::move(report.log, std::back_inserter(log_));
  for (auto& failure : report.failures) {
    const auto& robot = watched_.layout.robots[failure.robot];
    print_log();
    const auto& controller = watched_.scene.controllers[robot.controller].id;
    watched_.console.fault(fmt::format("robot {} (controller '{}') failed at tick {}: {}", robot.id,
                                       controller, failure.tick, failure.message));
    failures_.push_back(
        {failure.robot, {robot.id, controller, failure.tick, std::move(failure.message)}});
  }
}

void Watch::print_log() {
  std::ranges::stable_sort(log_, {}, &wire::LogLine::robot);
  for (const auto& line : log_) {
    watched_.console.log_line(tick_, watched_.layout.robots[line.robot].id, line.text, line.error);
  }
  log_.clear();
  watched_.console.flush();
}

std::vector<std::size_t> Watch::missing_robots() const {
  std::vector<std::size_t> robots;
  const auto status = watched_.server.status();
  for (std::size_t r = 0; r < status.size(); ++r) {
    if (status[r].membership == Membership::free && is_waited_for(status[r])) robots.push_back(r);
  }
  return robots;
}

std::vector<std::size_t> Watch::awaited_robots() const {
  std::vector<std::size_t> robots;
  const auto status = watched_.server.status();
  for (std::size_t r = 0; r < status.size(); ++r) {
    if (status[r].membership != Membership::gone && status[r].awaited) robots.push_back(r);
  }
  return robots;
}

/// Whether the run can't go on without the process.
bool Watch::is_awaited(const processes::ControllerProcess& process) const {
  const auto status = watched_.server.status();
  return std::ranges::any_of(process.robots, [&](std::size_t robot) {
    return status[robot].membership != Membership::gone && is_waited_for(status[robot]);
  });
}

/// Whether nobody's absence is forgiven: before the first tick nobody's is, later a deadline's
/// policy decides.
bool Watch::is_waited_for(const network::RobotStatus& robot) const {
  return !gathered_ || robot.deadline.action == scene::DeadlineAction::wait;
}

// "r0, r1 (controller 'drive'), r7 (controller 'lift')"
std::string Watch::by_controller(const std::vector<std::size_t>& robots) const {
  std::string text;
  for (std::size_t c = 0; c < watched_.scene.controllers.size(); ++c) {
    std::vector<std::size_t> driven;
    std::ranges::copy_if(robots, std::back_inserter(driven), [&](std::size_t robot) {
      return watched_.layout.robots[robot].controller == c;
    });
    if (driven.empty()) continue;
    text +=
        fmt::format("{}{} (controller '{}')", text.empty() ? "" : ", ",
                    processes::names_of(driven, watched_.layout), watched_.scene.controllers[c].id);
  }
  return text;
}

void Watch::say_who_is_awaited() {
  const auto waited = clock::now() - waiting_since_;
  const auto robots = awaited_robots();
  if (progress_.due()) {
    progress_.show(tick_, waited > noticeable ? by_controller(robots) : std::string());
  }
  // Somebody has to act if nobody was started for them: say so at once.
  const auto has_process = [&](std::size_t robot) {
    return std::ranges::any_of(watched_.processes, [&](const auto& process) {
      return std::ranges::find(process.robots, robot) != process.robots.end();
    });
  };
  const bool somebody_must_connect =
      std::ranges::any_of(missing_robots(), [&](std::size_t robot) { return !has_process(robot); });
  if (!somebody_must_connect && waited < long_wait) return;
  auto text = by_controller(robots);
  if (text.empty() || text == said_) return;
  const auto where =
      somebody_must_connect
          ? fmt::format(" to connect to {}", fmt::join(watched_.server.endpoints(), " or "))
          : std::string();
  watched_.console.notice(fmt::format("waiting for {}{}", text, where));
  said_ = std::move(text);
}

void Watch::wind_down(const wire::End& end) {
  watched_.server.finish(end);
  const std::array descriptors{watched_.signals.descriptor()};
  const auto deadline = clock::now() + farewell;
  while (clock::now() < deadline) {
    const auto outcome = watched_.server.drain({look_closely, descriptors});
    take_report();
    if (outcome == network::Outcome::complete) break;
    if (watched_.signals.take().interruptions > 0) {
      for (auto& each : watched_.processes) each.process.signal(SIGKILL);
      break;
    }
  }
  print_log();
  end_processes();
}

void Watch::end_processes() {
  std::vector<processes::ChildProcess*> children;
  for (auto& each : watched_.processes) children.push_back(&each.process);
  processes::end_all(children, patience_ms,
                     [&] { return watched_.signals.take().interruptions > 0; });
}

std::vector<reports::Summary::Failure> Watch::failures() const {
  auto sorted = failures_;
  std::ranges::sort(sorted, {},
                    [](const auto& each) { return std::tuple(each.second.tick, each.first); });
  std::vector<reports::Summary::Failure> result;
  for (auto& [robot, failure] : sorted) result.push_back(std::move(failure));
  return result;
}

}  // namespace ziggurat::run
