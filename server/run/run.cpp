// SPDX-License-Identifier: MIT
#include "run/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <span>
#include <utility>

#include "processes/commands.h"
#include "processes/python_package.h"
#include "processes/scripts.h"
#include "run/background.h"
#include "run/build.h"
#include "run/files.h"
#include "run/options/option_checks.h"
#include "run/options/option_table.h"
#include "run/setup.h"
#include "text/numbers.h"

namespace ziggurat::run {

using reports::Ending;
using timing::Phase;

namespace {

void keep(const std::vector<world::Metric>& metrics, reports::Summary& summary) {
  for (const world::Metric& metric : metrics) {
    summary.metrics.insert_or_assign(world::key_of(metric), metric.value);
  }
}

/// Metrics of the last tick, and metrics that controllers set after the end of the run.
std::vector<world::Metric> last_metrics(const network::Server& server, const Watch& watch,
                                        reports::Summary& summary) {
  std::vector<world::Metric> metrics = watch.measured();
  keep(metrics, summary);
  wire::Status status;
  server.fill(status);
  for (const world::Metric& metric : status.metrics) {
    const auto known = summary.metrics.find(world::key_of(metric));
    const bool is_known = known != summary.metrics.end() && known->second == metric.value;
    if (!is_known) metrics.push_back(metric);
  }
  keep(metrics, summary);
  return metrics;
}

}  // namespace

Run::Run(const Options& options, StartPoint& start, Service service, processes::Signals& signals)
    : options_(options),
      start_(start),
      service_(service),
      signals_(signals),
      console_({options.quiet, options.json}),
      local_(signals.guardian()),
      config_(network_config(options, service == Service::serve, local_)),
      listening_(listen()),
      server_(*listening_),
      loaded_(load_world()),
      world_(*loaded_),
      plan_(make_plan()),
      with_controllers_(!options_.without_controllers && !(options_.pictures && plan_.ticks == 0)),
      folder_(signals.guardian()),
      programs_(start.programs(world_, folder_.path() + "/files", with_controllers_)),
      recorders_(options_, world_),
      recorded_(start.is_reached() ? start_recording() : nullptr),
      controllers_(start_controllers()),
      callers_(server_),
      population_({options_.scene_file.max_size, with_controllers_, leaves_libraries(),
                   options_.spawned_script_folders},
                  world_, server_, callers_, controllers_, console_),
      supervision_(supervision_settings(), world_, server_, callers_, population_),
      directing_(world_, server_, callers_, population_, console_),
      schedule_(plan_.real_time, world_.simulation.tick_length()),
      live_view_(make_showing(options_, shown(world_, server_, callers_, supervision_, schedule_,
                                              statistics_.summary, plan_.ticks.value_or(0)))),
      watch_({.metrics = options_.metrics,
              .insecure = options_.insecure,
              .fail_fast = options_.fail_fast,
              .waits_for_clients = service == Service::serve,
              .ticks = plan_.ticks,
              .restarts = restarts_of(options_.restarts, world_.scene)},
             world_, server_, controllers_, supervision_, signals, console_, live_view_.get(),
             [this](auto severity, auto name, auto text) {
               if (live_view_) live_view_->log(severity, name, text);
               if (recorded_) recorded_->log(severity, name, text);
             }),
      waits_for_viewer_(live_view_ && !options_.paused) {
  callers_.on_world_change([this](const supervision::WorldChange& change) {
    if (recorded_) recorded_->record(change);
  });
  print_notices();
  statistics_.summary.scene = start.scene_path();
  statistics_.summary.robots = world_.simulation.layout().robots.size();
}

/// A killed program cannot remove the files of its sockets: the guardian has their names before
/// they are made.
std::unique_ptr<network::Server> Run::listen() const {
  const processes::Guardian* const guardian = signals_.guardian();
  for (const std::string& endpoint : config_.endpoints) {
    const std::string file = network::file_of(endpoint);
    if (guardian != nullptr && !file.empty()) guardian->remove_dead_socket(file);
  }
  return std::make_unique<network::Server>(config_);
}

/// Answers clients while another thread loads the world, which alone uses the console meanwhile.
std::unique_ptr<supervision::World> Run::load_world() {
  if (service_ == Service::serve) announce(options_, server_.endpoints(), console_);
  Background<std::unique_ptr<supervision::World>> loading([this](const TellLoading& tell) {
    return start_.build(
        [&](double share, const std::string& message) {
          console_.progress(fmt::format("{:.0f} %: {}", 100 * share, message));
          tell(share, message);
        },
        console_);
  });
  const std::array descriptors{signals_.descriptor(), loading.descriptor()};
  for (;;) {
    const auto status = loading.status();
    if (status.is_done) {
      auto world = loading.take();
      apply_scene(world->scene, options_);
      world->simulation.set_threads(threads_for(options_, world->simulation.entities()));
      if (service_ == Service::serve)
        tell_how_to_connect(options_, server_.endpoints().front(), *world, console_);
      return world;
    }
    server_.attend({status.progress, status.message}, {std::chrono::milliseconds{-1}, descriptors});
    if (signals_.take().interruptions == 0) continue;
    listening_.reset();  // tells clients that wait
    local_.release();
    end_while_loading();
  }
}

Plan Run::make_plan() const {
  Plan plan;
  plan.ticks = start_.last_tick(world_.scene);
  plan.real_time = options_.real_time;
  const bool is_paced = options_.hil || options_.view.has_value() ||
                        (!options_.pictures && world_.scene.experiment.real_time);
  if (!plan.real_time && is_paced) plan.real_time = 1;
  return plan;
}

network::Config Run::complete_config() {
  add_controllers(options_, world_.scene, config_);
  const auto& controllers = world_.scene.controllers;
  const ExpectedClients clients =
      expected_clients(options_, world_.scene, service_ == Service::serve, with_controllers_);
  check_client_options(options_, clients, config_);
  check_gate(options_.gate, {std::span(config_.deadlines).first(controllers.size()),
                             clients.can_connect, plan_.real_time.has_value()});
  if (service_ == Service::run || starts_directors(options_, world_.scene))
    config_.private_endpoint = "ipc://" + folder_.path() + "/run";
  return config_;
}

/// Whether nothing is in place of its library, and no client can be.
bool Run::is_left_alone(const scene::Controller& controller) const {
  return leaves_libraries() && scene::is_library(controller) && controller.command.empty();
}

bool Run::leaves_libraries() const {
  return options_.scene_file.lenient && service_ == Service::run && options_.endpoints.empty();
}

/// Robots whose Lua controller names no script, or that are left alone, or all robots if
/// controllers are not wanted. The run does not wait for them.
std::vector<std::size_t> Run::robots_without_controller() const {
  const auto& all = world_.simulation.layout().robots;
  std::vector<std::size_t> robots;
  for (std::size_t r = 0; r < all.size(); ++r) {
    const scene::Controller& controller = world_.scene.controllers[all[r].controller];
    const bool has_no_script = processes::runs_script(controller) && r < programs_.scripts.size() &&
                               programs_.scripts[r].empty();
    const bool has_no_library = is_left_alone(controller);
    const bool is_idle = std::ranges::find(programs_.idle, r) != programs_.idle.end();
    if (!with_controllers_ || has_no_script || has_no_library || is_idle) robots.push_back(r);
  }
  return robots;
}

processes::Controllers Run::start_controllers() {
  wire::Run run = description_of(world_, programs_.scripts);
  run.is_hardware_in_the_loop = options_.hil;
  run.directors = programs_.directors;
  server_.open(std::move(run), complete_config());
  server_.remove_robots(robots_without_controller());
  if (options_.starts_all_directors) check_programs(world_.scene);
  const bool starts_none = service_ == Service::serve && !starts_directors(options_, world_.scene);
  if (!with_controllers_ || starts_none) return {};
  return {world_.scene, world_.simulation.layout(), programs_.scripts, launch_settings()};
}

processes::LaunchSettings Run::launch_settings() const {
  const unsigned threads = threads_for(options_, world_.simulation.entities());
  const std::size_t robots = world_.simulation.layout().robots.size();
  processes::LaunchSettings settings{
      server_.endpoints().front(),  folder_.path(),
      processes::find_lua_runner(), lua_processes_for(options_, threads, robots),
      options_.lua_arguments,       signals_.guardian(),
      programs_.directors};
  settings.only_directors = service_ == Service::serve;
  settings.scene_folder = programs_.folder;
  settings.python_path = processes::python_path(folder_.path());
  for (const auto* folders : {&programs_.script_folders, &options_.spawned_script_folders}) {
    for (const std::string& folder : *folders)
      settings.lua_arguments.insert(settings.lua_arguments.end(), {"--script-folder", folder});
  }
  const auto exceptions = exceptions_of(options_, programs_.fixed_files);
  settings.lua_arguments.insert(settings.lua_arguments.end(), exceptions.begin(), exceptions.end());
  return settings;
}

std::unique_ptr<RecordedRun> Run::start_recording() {
  if (options_.record.empty()) return nullptr;
  return std::make_unique<RecordedRun>(options_, world_, start_, plan_.ticks.value_or(0),
                                       robots_without_controller(), console_);
}

supervision::Supervision::Settings Run::supervision_settings() {
  return {plan_.ticks.value_or(0), options_.hil, options_.snapshot_folder,
          fmt::format("{}, {}", version, __VERSION__), [this] { recorders_.flush(); }};
}

int Run::execute() {
  try {
    statistics_.summary.ending = run_to_end();
    recorders_.close();
  } catch (const std::exception& error) {
    end_in_failure(error);
    throw;
  }
  complete_summary();
  watch_.end_run(end_message(statistics_.summary));
  const std::vector<world::Metric> metrics = last_metrics(server_, watch_, statistics_.summary);
  if (recorded_) {
    recorded_->close(metrics);
    statistics_.summary.recording_failure = recorded_->failure();
  }
  statistics_.summary.failures = watch_.reported().failures();
  statistics_.summary.departures = watch_.reported().departures();
  recorders_.write_summary(statistics_.summary);
  for (const auto& picture : recorders_.pictures()) console_.result(picture);
  if (const auto missing = recorders_.missing_frames(); !missing.empty()) console_.warning(missing);
  const bool has_passed = report_hil();
  print_summary();
  int code = exit_code_of(statistics_.summary);
  if (code == reports::exit_code::finished && !has_passed) code = reports::exit_code::gate_missed;
  const bool is_stopped = statistics_.summary.ending == Ending::interrupted ||
                          statistics_.summary.ending == Ending::forced;
  if (live_view_ && !is_stopped) {
    console_.notice("the run is over; its last state is shown until Ctrl-C");
    console_.flush();
    watch_.show_end();
  }
  signals_.completed(code);
  return code;
}

/// Takes the world to where the run begins. Supervisors wait meanwhile.
std::optional<Ending> Run::reach_start() {
  callers_.hold(true);
  const auto ending = start_.reach({world_, programs_, robots_without_controller(), server_,
                                    controllers_, watch_, signals_, console_});
  callers_.hold(false);
  if (ending) return ending;
  if (!recorded_) recorded_ = start_recording();
  if (options_.paused) server_.set_paused(true);
  return std::nullopt;
}

/// From the start to the end, again after each reset.
Ending Run::run_to_end() {
  if (const auto ending = reach_start()) return *ending;
  for (;;) {
    statistics_.watch.enter(Phase::startup);
    std::optional<Ending> ending = wait([&] { return watch_.gather(); });
    if (!ending) {
      supervision_.gathered();
      ending = run_world();
    }
    statistics_.summary.wall += statistics_.watch.take();
    if (ending != Ending::reset) return *ending;
  }
}

/// One world, from tick 0 or a snapshot on.
Ending Run::run_world() {
  simulation::Simulation& simulation = world_.simulation;
  const wire::Truth truth{simulation.layout(), simulation.entities(), simulation.state(),
                          simulation.observations(), simulation.contacts()};
  schedule_.begin(simulation.state().tick, supervision_.paused_for());
  for (;;) {
    statistics_.watch.enter(Phase::encode);
    // Controllers compute while the files are written.
    server_.publish(simulation.observations(), simulation.state().tag_payloads, &truth);
    supervision_.published();
    statistics_.watch.enter(Phase::recording);
    recorders_.tick(simulation);
    if (recorded_) recorded_->tick();
    if (live_view_) live_view_->tick(statistics_.last_tick);

    statistics_.watch.enter(Phase::wait);
    auto stopped = collect();
    const bool is_last = simulation.state().tick == plan_.ticks;
    if (!stopped && !is_last && (schedule_.is_paced() || waits_for_viewer_)) {
      stopped = pace();
      if (!stopped) stopped = collect();
    }
    if (stopped) return *stopped;
    statistics_.watch.enter(Phase::recording);
    radio_watch_.tick(simulation.observations(), simulation.commands());
    recorders_.exchange(simulation.state(), simulation.observations(), simulation.commands(),
                        watch_.measured());
    keep(watch_.measured(), statistics_.summary);
    if (live_view_ && !watch_.measured().empty()) live_view_->measured();
    if (live_view_) live_view_->answered();
    statistics_.summary.result = directing_.result();
    if (is_last || statistics_.summary.result) return Ending::finished;
    statistics_.watch.enter(Phase::forces);
    directing_.act();
    if (recorded_) recorded_->step(watch_.measured());
    simulation.list_contacts((live_view_ && live_view_->wants_contacts()) ||
                             (recorded_ && recorded_->wants_contacts()) ||
                             directing_.wants_contacts());
    simulation.list_rays((live_view_ && live_view_->wants_rays()) ||
                         (options_.pictures && options_.pictures->view.layers.rays));
    simulation.step(&statistics_.watch);
    print_troubles();
    end_tick();
  }
}

void Run::end_tick() {
  statistics_.last_tick = statistics_.watch.take();
  statistics_.summary.wall += statistics_.last_tick;
  supervision_.add(statistics_.last_tick);
}

/// Until the tick is complete. Again if the world is paused then, or if a client has connected to a
/// complete tick: it must answer, too.
std::optional<Ending> Run::collect() {
  simulation::Simulation& simulation = world_.simulation;
  do {
    auto stopped =
        wait([&] { return watch_.collect(simulation.commands(), simulation.state().tick); });
    if (stopped) return stopped;
  } while (server_.pause() == network::Pause::halted);
  return std::nullopt;
}

/// Until the tick's time on the wall clock; at first until a viewer is there, if the run is shown.
std::optional<Ending> Run::pace() {
  const std::uint64_t tick = world_.simulation.state().tick;
  if (std::exchange(waits_for_viewer_, false)) {
    statistics_.watch.enter(Phase::startup);
    const auto stopped = wait([&] { return watch_.wait_for_viewer(world_.simulation.commands()); });
    if (stopped) return stopped;
    schedule_.begin(tick, supervision_.paused_for());
  }
  const auto moment = [&] { return schedule_.end_of(tick, supervision_.paused_for()); };
  if (!schedule_.is_paced()) return std::nullopt;
  statistics_.watch.enter(Phase::pacing);
  const bool is_late = Watch::clock::now() > moment();
  if (is_late) ++statistics_.summary.late_ticks;
  const auto stopped =
      wait([&] { return watch_.sleep_until(moment, world_.simulation.commands()); });
  if (stopped || !config_.keeps_reactions) return stopped;
  const std::chrono::duration<double> late = Watch::clock::now() - moment();
  const auto next = static_cast<std::uint32_t>(tick + 1);
  statistics_.tick_starts.push_back(
      {statistics_.resets, next, std::max(late.count(), 0.0), is_late});
  return std::nullopt;
}

/// Does a wait of the watch, again if it was interrupted by a reset that is refused.
std::optional<Ending> Run::wait(const Wait& step) {
  for (;;) {
    const auto ending = step();
    if (ending != Ending::reset || reset_world()) return ending;
  }
}

/// To the start, or to a snapshot. False if the world can't be put back so.
bool Run::reset_world() {
  if (!supervision_.restart()) return false;
  watch_.forget_spawned();
  ++statistics_.resets;
  if (live_view_) live_view_->restarted();
  statistics_.summary.metrics.clear();
  return true;
}

}  // namespace ziggurat::run
