// SPDX-License-Identifier: MIT
#include "run/live_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "run/build.h"
#include "run/files.h"

namespace ziggurat::run {
namespace {

using channels::Kind;

constexpr std::chrono::milliseconds fresh_interval(16);  // a viewer could subscribe again and again
constexpr std::chrono::milliseconds barrier_interval{250};
constexpr const char* over = "The run is over: its last state is shown, and nothing changes it.";
constexpr const char* over_for_good =
    "The run is over and its controllers have ended, so it can't be reset; start the program "
    "again, "
    "with --duration=0 for a run that does not end by itself.";

view::Settings settings_of(const Options& options, const LiveView::Run& run) {
  view::Settings settings;
  if (!options.view->empty()) settings.address = http::to_address("--view", *options.view);
  settings.insecure = options.insecure;
  settings.token = options.view_token;
  settings.folder = shared_folder("web");
  settings.version = version;
  settings.scene = run.world.path;
  settings.parameters = {{"real_time_factor", run.schedule.factor().value_or(0)},
                         {"frames_per_second", 60.0},
                         {"draw_labels", false},
                         {"draw_frusta", true},
                         {"phase", std::string("gathering")}};
  if (run.is_replay) settings.parameters.push_back({"replay", true});
  return settings;
}

const char* name_of(wire::Status::Phase phase) {
  switch (phase) {
    case wire::Status::Phase::running:
      return "running";
    case wire::Status::Phase::paused:
      return "paused";
    case wire::Status::Phase::ending:
      return "over";
    default:
      return "gathering";
  }
}

}  // namespace

std::string wait_notice() {
  return fmt::format("waits for a viewer, for {} s at most", longest_wait_for_viewer.count());
}

LiveView::LiveView(const Options& options, Run run)
    : run_(run), server_(settings_of(options, run)) {
  connect_callers();
  populate();
}

void LiveView::connect_callers() {
  run_.connect({[this] { return take_calls(); },
                [this](const network::Call& call) {
                  const auto found = unanswered_.find(call.request.id);
                  return found != unanswered_.end() &&
                         server_.requests().is_connected(found->second.viewer);
                },
                [this](const network::Call& call, std::uint64_t tick) {
                  const auto found = unanswered_.extract(call.request.id);
                  if (found) server_.answer(found.mapped(), tick);  // otherwise the viewer has left
                },
                [this](const network::Call& call, const std::string& why) {
                  const auto found = unanswered_.extract(call.request.id);
                  if (found) server_.refuse(found.mapped(), why);
                }});
}

std::vector<network::Call> LiveView::take_calls() {
  std::erase_if(unanswered_, [&](const auto& entry) {
    return !server_.requests().is_connected(entry.second.viewer);
  });
  std::vector<network::Call> calls;
  for (view::ViewerCall& call : std::exchange(calls_, {})) {
    network::Call& taken = calls.emplace_back();
    taken.peer = fmt::format("viewer {}", call.viewer);
    taken.request = call.request;
    taken.request.id = next_call_++;
    taken.is_local = true;
    unanswered_.emplace(taken.request.id, std::move(call));
  }
  return calls;
}

channels::Moment LiveView::moment() const {
  simulation::Simulation& simulation = run_.world.simulation;
  return {simulation.state(),
          simulation.observations(),
          simulation.commands(),
          simulation.contacts(),
          phases_,
          simulation.rays()};
}

void LiveView::populate() {
  const supervision::World& world = run_.world;
  server_.populate({world.scene, world.path, world.scene_hash, world.seed, run_.last_tick,
                    world.simulation.layout(), world.simulation.entities(),
                    world.simulation.state()});
  shown_image_ = world::image_on(world.simulation.state().floor);
}

/// Observations that channels show which are wanted.
channels::Sensed LiveView::sensed() const {
  using channels::Sensed;
  if (wants(Kind::image)) return Sensed::numbers_and_pictures;
  for (std::size_t kind = 0; kind < kinds_.size(); ++kind) {
    if (kinds_.test(kind) && shows_observations(static_cast<Kind>(kind))) return Sensed::numbers;
  }
  return Sensed::nothing;
}

void LiveView::show_tick() {
  if (!wanted_.empty()) server_.show(moment(), {wanted_, {}, sensed()});
}

void LiveView::show_all(const std::vector<std::uint32_t>& wanted) {
  if (!wanted.empty()) server_.show(moment(), {wanted, wanted, sensed()});
}

void LiveView::tick(const timing::PhaseTimes& phases) {
  is_current_ = false;
  is_gathered_ = true;
  if (world::image_on(run_.world.simulation.state().floor) != shown_image_) {
    populate();
    phases_ = phases;
    is_current_ = true;
    return show_all(wanted_);
  }
  if (!has_viewers() || wanted_.empty()) return;
  phases_ = phases;
  const auto now = clock::now();
  const std::chrono::duration<double> least(0.9 / frames_per_second_);
  if (now - last_frame_ < least) return;
  last_frame_ = now;
  is_current_ = true;
  show_tick();
}

void LiveView::answered() {
  if (!is_current_) return;
  if (wants(Kind::command)) server_.show_commands(moment(), wanted_);
  if (has_new_metrics_ && wants(Kind::metrics)) show_metrics();
}

void LiveView::restarted() {
  is_gathered_ = false;
  populate();
  seen_changes_ = run_.changes();
  is_current_ = true;
  show_all(wanted_);
}

void LiveView::log(channels::Severity severity, std::string_view name, std::string_view text) {
  if (!wants(Kind::log)) return;
  const std::int64_t time_ns = run_.world.simulation.state().time_ns;
  server_.show_event(channels::Channels::log(time_ns, severity, name, text));
}

void LiveView::serve() {
  if (!server_.requests().has_changes()) return;
  view::ViewerRequests::Changes changes = server_.requests().take();
  wanted_ = std::move(changes.wanted);
  kinds_ = changes.kinds;
  for (const view::Parameter& parameter : changes.parameters) apply(parameter);
  for (view::ViewerCall& call : changes.calls) {
    if (call.speed) {
      set_speed(*call.speed);
      server_.answer(call, run_.world.simulation.state().tick);
    } else if (is_over_ && call.request.kind != wire::Request::Kind::shutdown) {
      const bool is_reset = call.request.kind == wire::Request::Kind::reset;
      server_.refuse(call, is_reset ? over_for_good : over);
    } else if (is_over_) {
      server_.answer(call, run_.world.simulation.state().tick);
      shutdown_ = true;
    } else {
      calls_.push_back(std::move(call));
    }
  }
  fresh_.insert(fresh_.end(), changes.fresh.begin(), changes.fresh.end());
}

void LiveView::apply(const view::Parameter& parameter) {
  if (parameter.name == "real_time_factor") return set_speed(std::get<double>(parameter.value));
  if (parameter.name == "frames_per_second") {
    frames_per_second_ = std::get<double>(parameter.value);
    return;
  }
  (parameter.name == "draw_labels" ? layers_.labels : layers_.frusta) =
      std::get<bool>(parameter.value);
  server_.set_layers(layers_);
  show_all(wanted_);
}

void LiveView::set_speed(double factor) {
  run_.schedule.set_factor(factor > 0 ? std::optional(factor) : std::nullopt,
                           run_.world.simulation.state().tick, run_.paused_for());
  server_.set_parameter({"real_time_factor", factor});
}

void LiveView::update() {
  if (seen_changes_ != run_.changes()) {
    seen_changes_ = run_.changes();
    populate();
    is_current_ = true;
    show_all(wanted_);
  }
  if (!has_viewers()) return;
  const auto now = clock::now();
  if (!fresh_.empty() && now - last_fresh_ >= fresh_interval) {
    last_fresh_ = now;
    last_barrier_ = {};
    std::ranges::sort(fresh_);
    std::vector<std::uint32_t> still_wanted;
    std::ranges::set_intersection(wanted_, fresh_, std::back_inserter(still_wanted));
    fresh_.clear();
    show_all(still_wanted);
    if (std::ranges::binary_search(still_wanted, channels::Channels::id_of(Kind::metrics))) {
      show_metrics();
    }
  }
  const std::chrono::duration<double> least(0.9 / frames_per_second_);
  if (!is_current_ && !wanted_.empty() && now - last_frame_ >= least) {  // while the world waits
    last_frame_ = now;
    is_current_ = true;
    show_tick();
  }
  const auto phase = is_over_           ? wire::Status::Phase::ending
                     : run_.is_paused() ? wire::Status::Phase::paused
                     : is_gathered_     ? wire::Status::Phase::running
                                        : wire::Status::Phase::gathering;
  if (phase != phase_) {
    phase_ = phase;
    server_.set_parameter({"phase", std::string(name_of(phase))});
    last_barrier_ = {};
  }
  if (wants(Kind::barrier) && now - last_barrier_ >= barrier_interval) {
    last_barrier_ = now;
    show_barrier();
  }
}

void LiveView::show_barrier() {
  wire::Status status = run_.status();
  if (is_over_) status.phase = wire::Status::Phase::ending;
  const auto controllers = run_.controllers();
  std::vector<channels::Histogram> histograms;
  for (std::size_t c = 0; c < controllers.size(); ++c) {
    const network::AnswerTimes& times = controllers[c].answer_times;
    histograms.push_back({run_.world.scene.controllers[c].id, times.least, times.growth,
                          times.counts, controllers[c].missed_ticks});
  }
  server_.show_event(channels::Channels::barrier(status, histograms));
}

void LiveView::show_metrics() {
  has_new_metrics_ = false;
  const std::map<std::string, double>& values = run_.metrics();
  if (values.empty()) return;
  const world::State& state = run_.world.simulation.state();
  server_.show_event(channels::Channels::metrics(state.tick, state.time_ns, values));
}

void LiveView::end() {
  is_over_ = true;
  for (const auto& [id, call] : unanswered_) server_.refuse(call, over);
  unanswered_.clear();
  update();
}

}  // namespace ziggurat::run
