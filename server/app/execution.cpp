#include "app/execution.h"

#include <fmt/format.h>

#include <exception>
#include <nlohmann/json.hpp>

#include "app/console.h"
#include "app/drive.h"
#include "app/loading.h"
#include "app/private_folder.h"
#include "app/recorders.h"
#include "app/scripts.h"
#include "app/signals.h"
#include "app/summary.h"
#include "app/version.h"
#include "app/watch.h"
#include "recording/hash_file.h"

namespace ziggurat::app {
namespace {

constexpr const char* default_endpoint = "tcp://127.0.0.1:5770";

network::Config network_config(const Options& options, Service service,
                               const PrivateFolder& folder) {
  network::Config config;
  config.insecure = options.insecure;
  if (service == Service::run) config.endpoints.push_back("ipc://" + folder.path() + "/run");
  config.endpoints.insert(config.endpoints.end(), options.endpoints.begin(),
                          options.endpoints.end());
  if (config.endpoints.empty()) config.endpoints.emplace_back(default_endpoint);
  return config;
}

wire::Run wire_run(const scene::Scene& scene, const simulation::Simulation& simulation,
                   std::vector<std::string> scripts, std::uint64_t seed) {
  wire::Run run{simulation.layout(), scene.controllers, std::move(scripts), seed, 0, 1, {}, {}};
  run.ticks_per_second = scene.experiment.ticks_per_second;
  run.tick_ns = (1'000'000'000 + run.ticks_per_second / 2) / run.ticks_per_second;
  run.scene_hash = scene_hash(scene);
  run.server_version = version;
  return run;
}

Plan make_plan(const Options& options, const scene::Scene& scene) {
  Plan plan;
  plan.ticks = options.pictures ? last_tick(*options.pictures, scene.experiment)
                                : tick_count(options, scene);
  plan.real_time = options.real_time;
  if (!plan.real_time && !options.pictures && scene.experiment.real_time) plan.real_time = 1;
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
    } else if (runs_script(scene.controllers[layout.robots[r].controller]) && scripts[r].empty()) {
      robots.push_back(r);
    }
  }
  return robots;
}

void announce(const Options& options, const network::Server& server, Console& console) {
  const auto& endpoints = server.endpoints();
  if (options.json) {
    console.result(
        nlohmann::ordered_json{{"endpoint", endpoints.front()}, {"endpoints", endpoints}}.dump());
  } else {
    for (const auto& endpoint : endpoints) console.result("endpoint " + endpoint);
  }
  console.flush();
}

wire::End end_message(const Summary& summary) {
  wire::End end;
  end.tick = summary.ticks;
  end.message = summary.vanished;
  switch (summary.ending) {
    case Ending::finished:
      end.reason = wire::EndReason::finished;
      break;
    case Ending::interrupted:
    case Ending::forced:
      end.reason = wire::EndReason::interrupted;
      break;
    case Ending::controller_vanished:
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
  } catch (const ConsoleError&) {  // likewise; processes end with their owners
  }
}

void complete(Summary& summary, const simulation::Simulation& simulation, const Watch& watch) {
  summary.ticks = simulation.state().tick;
  summary.simulated_s = static_cast<double>(summary.ticks) * simulation.tick_length();
  summary.wall_s = summary.physics_s + summary.exchange_s + summary.recording_s + summary.pacing_s;
  summary.hash = simulation.hash();
  summary.vanished = watch.vanished();
}

// What remains once every process has ended, in this order: the hash is the very last line.
void conclude(const Options& options, const Summary& summary, Console& console) {
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
  Console console({options.quiet, options.json});
  const auto& path = only_scene(options);
  const auto scene = load_scene(path, options, console);
  const auto plan = make_plan(options, scene);
  const auto seed = choose_seed(options, scene);
  simulation::Simulation simulation(scene, {seed, options.clock});
  for (const auto& notice : simulation.notices()) console.notice(path + ": " + notice);
  const auto scripts = script_paths(scene, simulation.layout(), path);

  // Until here Ctrl-C just ends the program; from here on there is something to clean up.
  Signals signals;
  const PrivateFolder folder;
  const auto run = wire_run(scene, simulation, scripts, seed);
  network::Server server(network_config(options, service, folder), run);
  // A picture of tick 0 is taken before anybody had a say.
  const bool with_controllers =
      !options.without_controllers && !(options.pictures && plan.ticks == 0);
  const auto undriven = undriven_robots(scene, simulation.layout(), scripts, with_controllers);
  server.remove_robots(undriven);
  Recorders recorders(options, scene, seed, simulation.layout());
  if (options.seed.value_or(scene.experiment.random_seed) == 0) {
    console.notice(fmt::format("seed {0} drawn; --seed {0} repeats this run", seed));
  }
  if (service == Service::serve) announce(options, server, console);

  std::vector<ControllerProcess> processes;
  if (service == Service::run && with_controllers) {
    const Surroundings surroundings{server.endpoints().front(), folder.path(), find_lua_runner(),
                                    options.lua_processes};
    processes = start_all(plan_controllers(scene, simulation.layout(), scripts, surroundings),
                          simulation.layout());
  }
  Watch watch(
      {scene, simulation.layout(), server, signals, processes, console, service == Service::serve},
      simulation.tick_length());
  const bool paused = service == Service::serve && !plan.real_time &&
                      undriven.size() == simulation.layout().robots.size();

  Summary summary;
  summary.scene = path;
  summary.seed = seed;
  summary.robots = simulation.layout().robots.size();
  try {
    summary.ending =
        paused ? watch.stay_paused() : drive(plan, simulation, server, watch, recorders, summary);
    recorders.close();
  } catch (const std::exception& error) {
    // Ours to report, but controllers are told first and the other files completed.
    end_in_failure(error, simulation.state().tick, watch, recorders);
    throw;
  }
  complete(summary, simulation, watch);
  watch.wind_down(end_message(summary));
  summary.failures = watch.failures();
  recorders.write_summary(summary);
  for (const auto& picture : recorders.pictures()) console.result(picture);
  conclude(options, summary, console);
  return exit_code_of(summary);
}

}  // namespace ziggurat::app
