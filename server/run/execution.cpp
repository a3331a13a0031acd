#include "run/execution.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>

#include "network/reception.h"
#include "processes/private_folder.h"
#include "processes/scripts.h"
#include "processes/signals.h"
#include "recording/hash_file.h"
#include "recording/output_file.h"
#include "reports/console.h"
#include "reports/metrics.h"
#include "reports/report_card.h"
#include "reports/summary.h"
#include "run/drive.h"
#include "run/loading.h"
#include "run/recorders.h"
#include "run/version.h"
#include "run/watch.h"
#include "supervision/supervision.h"

namespace ziggurat::run {
namespace {

constexpr const char* default_endpoint = "tcp://127.0.0.1:5770";

// Hardware does not wait: whoever has no policy is held to its last command when the next tick is
// near.
void wait_for_nobody(const Options& options, const scene::Scene& scene,
                     std::vector<network::Config::Deadline>& deadlines) {
  const double factor = options.real_time.value_or(1);
  const double tick_ms = 1000.0 / scene.experiment.ticks_per_second / factor;
  const auto ms = static_cast<std::uint32_t>(std::max(1.0, std::floor(0.9 * tick_ms)));
  for (std::size_t c = 0; c < deadlines.size(); ++c) {
    if (deadlines[c].is_fixed || scene.controllers[c].deadline) continue;
    deadlines[c].policy = {scene::DeadlineAction::hold, ms, 0};
  }
}

// What can be said before there is a scene.
network::Config network_config(const Options& options, Service service) {
  network::Config config;
  config.insecure = options.insecure;
  config.lease = std::chrono::milliseconds(static_cast<std::int64_t>(options.lease * 1000));
  if (!options.curve_secret.empty()) {
    config.curve = {network::read_secret_key(options.curve_secret),
                    network::read_client_keys(options.curve_clients)};
  }
  config.endpoints = options.endpoints;
  if (service == Service::serve && config.endpoints.empty())
    config.endpoints.emplace_back(default_endpoint);
  return config;
}

// What the scene and the command line say of each controller.
void add_controllers(const Options& options, const scene::Scene& scene, network::Config& config) {
  config.deadlines = deadlines_of(options.deadlines, scene);
  if (options.hil) wait_for_nobody(options, scene, config.deadlines);
  config.injections = injections_of(options.injections, scene);
  check_losses(config.injections, scene, config.deadlines);
}

// A world that nobody drives would be over before anybody could look at it.
void begin_paused(network::Server& server, reports::Console& console) {
  server.pause();
  console.notice(
      "paused: the scene has no controllers; --real-time or 'ziggurat ctl URL resume' "
      "makes it run");
}

wire::Run wire_run(const scene::Scene& scene, const simulation::Simulation& simulation,
                   std::vector<std::string> scripts, std::uint64_t seed,
                   bool is_hardware_in_the_loop) {
  wire::Run run{simulation.layout(), scene.controllers, std::move(scripts), seed, 0, 1, {}, {}};
  run.ticks_per_second = scene.experiment.ticks_per_second;
  run.tick_ns = (1'000'000'000 + run.ticks_per_second / 2) / run.ticks_per_second;
  run.scene_hash = scene_hash(scene);
  run.server_version = version;
  run.is_hardware_in_the_loop = is_hardware_in_the_loop;
  return run;
}

Plan make_plan(const Options& options, const scene::Scene& scene) {
  Plan plan;
  plan.ticks = options.pictures ? last_tick(*options.pictures, scene.experiment)
                                : tick_count(options, scene);
  plan.real_time = options.real_time;
  plan.clock = options.clock;
  const bool is_paced = options.hil || (!options.pictures && scene.experiment.real_time);
  if (!plan.real_time && is_paced) plan.real_time = 1;
  return plan;
}

// Nobody drives them, nobody waits for them: robots whose Lua controller names no script, or all if
// controllers are not wanted.
std::vector<std::size_t> undriven_robots(const scene::Scene& scene, const world::Layout& layout,
                                         const std::vector<std::string>& scripts,
                                         bool with_controllers) {
  std::vector<std::size_t> robots;
  for (std::size_t r = 0; r < layout.robots.size(); ++r) {
    if (!with_controllers) {
      robots.push_back(r);
    } else if (processes::runs_script(scene.controllers[layout.robots[r].controller]) &&
               scripts[r].empty()) {
      robots.push_back(r);
    }
  }
  return robots;
}

void announce(const Options& options, const std::vector<std::string>& endpoints,
              reports::Console& console) {
  if (options.json) {
    console.result(
        nlohmann::ordered_json{{"endpoint", endpoints.front()}, {"endpoints", endpoints}}.dump());
  } else {
    for (const auto& endpoint : endpoints) console.result("endpoint " + endpoint);
  }
  console.flush();
}

wire::End end_message(const reports::Summary& summary) {
  wire::End end;
  end.tick = summary.ticks;
  end.message = summary.vanished;
  switch (summary.ending) {
    case reports::Ending::finished:
      end.reason = wire::EndReason::finished;
      break;
    case reports::Ending::interrupted:
    case reports::Ending::forced:
    case reports::Ending::reset:  // no run ends so
      end.reason = wire::EndReason::interrupted;
      break;
    case reports::Ending::controller_vanished:
    case reports::Ending::deadline_missed:
      end.reason = wire::EndReason::failed;
      break;
  }
  return end;
}

void end_in_failure(const std::exception& error, std::uint64_t tick, Watch& watch,
                    Recorders& recorders) {
  try {
    recorders.close();
  } catch (const recording::WriteError&) {  // the first error is the one to report
  }
  try {
    watch.wind_down({wire::EndReason::failed, error.what(), tick});
  } catch (const reports::ConsoleError&) {  // likewise; processes end with their owners
  }
}

void complete(reports::Summary& summary, const simulation::Simulation& simulation,
              const network::Server& server, const scene::Scene& scene, const Watch& watch) {
  summary.ticks = simulation.state().tick;
  summary.simulated_s = static_cast<double>(summary.ticks) * simulation.tick_length();
  summary.wall_s = summary.physics_s + summary.exchange_s + summary.recording_s + summary.pacing_s;
  summary.hash = simulation.hash();
  summary.vanished = watch.vanished();
  const auto missed = server.missed_ticks();
  for (std::size_t c = 0; c < missed.size(); ++c) {
    if (missed[c] > 0) summary.missed.push_back({scene.controllers[c].id, missed[c]});
  }
}

// On Ctrl-C before there is a world: reading and building have nothing to clean up.
[[noreturn]] void end_while_loading() {
  constexpr std::string_view text = "ziggurat: interrupted while loading\n";
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text.data(), text.size());
  std::_Exit(reports::exit_code::interrupted);
}

// How controllers kept up, if anybody asks. False if the gate was missed.
bool report_hil(const Options& options, const scene::Scene& scene, const network::Server& server,
                const reports::Summary& summary, reports::Console& console) {
  const bool is_wanted = options.hil || !options.injections.empty() || !options.gate.empty() ||
                         !options.report_card.empty();
  if (!is_wanted) return true;
  reports::ReportCard card{{}, summary.ticks, summary.late_ticks, options.gate};
  const auto missed = server.missed_ticks();
  const auto injections = injections_of(options.injections, scene);
  for (std::size_t c = 0; c < scene.controllers.size(); ++c) {
    const auto& latencies = server.latencies()[c];
    if (latencies.count() == 0 && missed[c] == 0) continue;  // drives no robot
    card.controllers.push_back(
        {scene.controllers[c].id, latencies, missed[c], injections[c], server.lost_messages()[c]});
  }
  if (!options.report_card.empty()) {
    const bool is_picture = options.report_card.ends_with(".svg");
    recording::OutputFile file(options.report_card);
    file.buffer().append(is_picture ? to_svg(card) : to_json(card) + "\n");
    file.close();
  }
  console.report(to_text(card));
  return reports::passes(card);
}

// What remains once every process has ended, in this order: the hash is the very last line.
void conclude(const Options& options, const reports::Summary& summary, reports::Console& console) {
  if (!summary.vanished.empty()) console.fault(summary.vanished);
  for (const auto& failure : summary.failures) {
    console.fault(fmt::format("robot {} (controller '{}') had failed at tick {}: {}", failure.robot,
                              failure.controller, failure.tick,
                              failure.message.substr(0, failure.message.find('\n'))));
  }
  console.report(options.json ? to_json(summary) : to_text(summary));
  if (options.hash) console.result(recording::hash_line(summary.ticks, summary.hash));
  console.flush();
}

}  // namespace

int execute(const Options& options, Service service) {
  reports::Console console({options.quiet, options.json});
  const auto& path = only_scene(options);
  // Nobody shall connect for a scene that is not there, and that is told before anything listens.
  if (!std::filesystem::exists(path)) load_scene(path, options, console);
  processes::Signals signals;
  auto config = network_config(options, service);
  network::Reception reception(config, {signals.descriptor(), end_while_loading});
  reception.say(0, "The scene is being read.");
  if (service == Service::serve) announce(options, reception.endpoints(), console);
  const auto [scene, additions] = load_scene(path, options, console);
  reception.say(0.5, "The world is being built.");
  const auto plan = make_plan(options, scene);
  const auto seed = choose_seed(options, scene);
  simulation::Simulation simulation(scene, {seed, options.clock});
  for (const auto& notice : simulation.notices()) console.notice(path + ": " + notice);
  const auto scripts = script_paths(scene, simulation.layout(), path);

  const processes::PrivateFolder folder;
  const auto run = wire_run(scene, simulation, scripts, seed, options.hil);
  add_controllers(options, scene, config);
  if (service == Service::run) config.private_endpoint = "ipc://" + folder.path() + "/run";
  network::Server server(config, run, reception);
  // A picture of tick 0 is taken before anybody had a say.
  const bool with_controllers =
      !options.without_controllers && !(options.pictures && plan.ticks == 0);
  const auto undriven = undriven_robots(scene, simulation.layout(), scripts, with_controllers);
  server.remove_robots(undriven);
  Recorders recorders(options, scene, seed, simulation.layout());
  if (options.seed.value_or(scene.experiment.random_seed) == 0) {
    console.notice(fmt::format("seed {0} drawn; --seed {0} repeats this run", seed));
  }
  std::vector<processes::ControllerProcess> processes;
  std::optional<processes::Surroundings> surroundings;
  if (service == Service::run && with_controllers) {
    surroundings = {server.endpoints().front(), folder.path(), processes::find_lua_runner(),
                    options.lua_processes};
    processes = processes::start_all(
        processes::plan_controllers(scene, simulation.layout(), scripts, *surroundings),
        simulation.layout());
  }
  supervision::Supervision supervision({scene, additions, options.reading.max_size, path,
                                        run.scene_hash, seed, options.clock, plan.ticks.value_or(0),
                                        options.hil, simulation, server, with_controllers,
                                        processes, surroundings, console});
  std::optional<reports::MetricsPort> metrics;
  if (!options.metrics.empty()) metrics.emplace(options.metrics, options.insecure);
  if (metrics) console.notice("metrics at " + metrics->url());
  Watch watch({scene, simulation.layout(), server, signals, processes, console, supervision,
               metrics ? &*metrics : nullptr, service == Service::serve},
              simulation.tick_length());
  const bool drives_nobody = undriven.size() == simulation.layout().robots.size();
  if (service == Service::serve && !plan.real_time && drives_nobody) begin_paused(server, console);

  reports::Summary summary;
  summary.scene = path;
  summary.seed = seed;
  summary.robots = simulation.layout().robots.size();
  try {
    summary.ending =
        drive(plan, {simulation, server, watch, supervision}, scene, recorders, summary);
    recorders.close();
  } catch (const std::exception& error) {
    // Ours to report, but controllers are told first and the other files completed.
    end_in_failure(error, simulation.state().tick, watch, recorders);
    throw;
  }
  complete(summary, simulation, server, scene, watch);
  summary.seed = supervision.seed();  // a reset may have changed it
  watch.wind_down(end_message(summary));
  summary.failures = watch.failures();
  recorders.write_summary(summary);
  for (const auto& picture : recorders.pictures()) console.result(picture);
  const bool has_passed = report_hil(options, scene, server, summary, console);
  conclude(options, summary, console);
  const int code = reports::exit_code_of(summary);
  return code == reports::exit_code::finished && !has_passed ? reports::exit_code::gate_missed
                                                             : code;
}

}  // namespace ziggurat::run
