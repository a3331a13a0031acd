// SPDX-License-Identifier: MIT
#include "run/watch.h"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <utility>

namespace ziggurat::run {
namespace {

using reports::Ending;
using std::chrono::milliseconds;

constexpr milliseconds usual_wait{200};  // between two looks while no message arrives
constexpr milliseconds short_wait{20};   // while a controller may have vanished

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
      last_tick_(settings.ticks),
      peers_(world, console, std::move(tell)),
      progress_(console, world.simulation.tick_length(), settings.ticks),
      notice_(world, server, directors_, controllers, console) {
  if (!settings.waits_for_clients) {
    lost_.emplace(LostControllers::Settings{settings.restarts, settings.ticks}, world, server,
                  controllers, console, peers_);
  }
  if (settings.metrics.empty()) return;
  metrics_.emplace(settings.metrics, settings.insecure);
  console_.notice("metrics at " + metrics_->url());
}

std::optional<Ending> Watch::gather() {
  now_.gathered = false;  // a reset may have freed robots
  const auto ending = until([&](const auto& wait) { return server_.gather(wait); });
  now_.gathered = !ending;
  return ending;
}

std::optional<Ending> Watch::collect(world::Commands& commands, std::uint64_t tick) {
  now_.tick = tick;
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
    if (progress_.needs_update()) progress_.show(now_.tick, "");
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
  notice_.begin();
  for (;;) {
    const bool is_short = lost_ && lost_->is_undecided();
    const auto outcome = step({is_short ? short_wait : usual_wait, descriptors_});
    serve();
    take_report();
    auto ending = interruption();
    if (!ending) ending = stopped_;
    if (!ending) ending = supervisor_request();
    const bool complete = outcome == network::Outcome::complete;
    if (!ending && lost_ && (!complete || lost_->may_be_some())) ending = lost_controller();
    if (ending || complete) {
      peers_.print_log(now_.tick);
      notice_.end();
      if (progress_.needs_update()) progress_.show(now_.tick, "");
      return ending;
    }
    notice_.tell(progress_, now_.tick, now_.gathered);
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
  if (arrived.child && lost_) lost_->child_ended();
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

std::optional<Ending> Watch::lost_controller() {
  auto sentence = lost_->look(now_);
  if (!sentence) return std::nullopt;
  vanished_ = std::move(*sentence);
  return Ending::controller_vanished;
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
    vanished_ = fmt::format("the run ends at tick {}, as --fail-fast asks", now_.tick);
  }
  if (now_.tick == last_tick_) report.departures.clear();  // nothing is left to be done
  std::ranges::copy(report.dropped, std::back_inserter(dropped_));
  peers_.take(std::move(report), now_.tick);
}

}  // namespace ziggurat::run
