// SPDX-License-Identifier: MIT
#include "run/setup.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string_view>
#include <thread>
#include <utility>

#include "processes/scripts.h"
#include "reports/json_text.h"
#include "run/build.h"
#include "text/hosts.h"
#include "text/numbers.h"
#include "text/quoting.h"

namespace ziggurat::run {
namespace {

/// Policy of controllers and directors without one of their own. Hardware in the loop does not
/// wait. Controllers hold their last command after nine tenths of a tick, and directors have no
/// acts in it.
scene::DeadlinePolicy usual_policy(const Options& options, const scene::Scene& scene) {
  if (!options.hil) return {};
  const double tick_ms = 1000.0 / scene.experiment.ticks_per_second / options.real_time.value_or(1);
  return {scene::DeadlineAction::hold,
          static_cast<std::uint32_t>(std::max(1.0, std::floor(0.9 * tick_ms))), 0};
}

bool has_program(const scene::Director& director) {
  return !director.script.empty() || !director.command.empty();
}

}  // namespace

network::Config network_config(const Options& options, bool is_serve, LocalEndpoints& local) {
  if (options.paused && options.endpoints.empty() && !is_serve && !options.view) {
    throw text::UsageError(
        "--paused needs --endpoint, where a supervisor can connect to resume, or --view");
  }
  if (!is_serve && !options.curve_secret.empty() && options.endpoints.empty()) {
    throw text::UsageError(
        "--curve-secret protects endpoints, and none is given; write --endpoint URL too, or leave "
        "it out");
  }
  network::Config config;
  config.insecure = options.insecure;
  config.allows_directors = options.allows_directors;
  config.lease = std::chrono::milliseconds(static_cast<std::int64_t>(options.lease * 1000));
  if (!options.curve_secret.empty()) {
    config.curve = {network::read_secret_key(options.curve_secret),
                    network::read_client_keys(options.curve_clients)};
  }
  config.endpoints = options.endpoints;
  for (std::string& endpoint : config.endpoints) {
    if (endpoint == "ipc://*") endpoint = local.any();
  }
  if (is_serve && config.endpoints.empty()) {
    config.endpoints.push_back(local.of_server(only_scene(options)));
  }
  return config;
}

void add_controllers(const Options& options, const scene::Scene& scene, network::Config& config) {
  auto deadlines = deadlines_of(options.deadlines, scene, usual_policy(options, scene));
  config.deadlines = std::move(deadlines.all);
  config.deadline_of_others = deadlines.of_others;
  config.injections = injections_of(options.injections, scene);
  config.keeps_reactions = wants_report_card(options);
  check_losses(config.injections, scene, config.deadlines);
}

void announce(const Options& options, const std::vector<std::string>& endpoints,
              reports::Console& console) {
  if (options.json) {
    console.result(reports::json_text({{"endpoint", endpoints.front()}, {"endpoints", endpoints}}));
  } else {
    for (const auto& endpoint : endpoints) console.result("endpoint " + endpoint);
  }
  console.offer();
}

void tell_how_to_connect(const Options& options, const std::string& listens_at,
                         const supervision::World& world, reports::Console& console) {
  const std::string endpoint = text::endpoint_to_call(listens_at);
  const bool is_protected = !options.curve_secret.empty();
  const std::string lua =
      fmt::format("connect with: ziggurat-lua --connect {}{}", endpoint,
                  is_protected ? " --server-key \"$(cat SERVER.public)\" --curve-secret FILE" : "");
  const std::string place = fmt::format(
      "{}ZIGGURAT_ENDPOINT={}",
      is_protected ? "ZIGGURAT_SERVER_KEY=\"$(cat SERVER.public)\" ZIGGURAT_CURVE_SECRET=FILE "
                   : "",
      endpoint);
  const auto program = [&](const char* name, const std::string& id, const std::string& command) {
    return fmt::format("connect with: {} {}={} {}", place, name, text::shell_word(id),
                       command.empty() ? "PROGRAM" : command);
  };
  std::vector<std::string> hints;
  const auto add = [&](std::string hint) {
    if (std::ranges::find(hints, hint) == hints.end()) hints.push_back(std::move(hint));
  };
  std::vector<bool> has_robots(world.scene.controllers.size());
  for (const auto& robot : world.simulation.layout().robots) has_robots[robot.controller] = true;
  for (std::size_t c = 0; c < has_robots.size(); ++c) {
    const scene::Controller& controller = world.scene.controllers[c];
    if (!has_robots[c]) continue;
    add(processes::runs_script(controller)
            ? lua
            : program("ZIGGURAT_CONTROLLER", controller.id, controller.command));
  }
  for (const scene::Director& director : world.scene.directors) {
    if (has_program(director) && !options.starts_no_directors) continue;
    add(director.script.empty() ? program("ZIGGURAT_DIRECTOR", director.id, director.command)
                                : lua + " --director " + text::shell_word(director.id));
  }
  constexpr std::size_t most = 8;
  for (std::size_t i = 0; i < std::min(most, hints.size()); ++i) console.notice(hints[i]);
  if (hints.size() > most) console.notice(fmt::format("and {} more", hints.size() - most));
  const std::string note = text::note_of_every_host(text::host_of_endpoint(listens_at));
  if (!note.empty() && !hints.empty()) console.notice(note);
}

wire::Run description_of(const supervision::World& world, const std::vector<std::string>& scripts) {
  const unsigned rate = world.scene.experiment.ticks_per_second;
  wire::Run run{
      world.simulation.layout(), world.scene.controllers, scripts, world.seed, 0, 1, {}, {}};
  run.ticks_per_second = rate;
  run.tick_ns = (1'000'000'000 + rate / 2) / rate;
  run.scene_hash = world.scene_hash;
  run.server_version = version;
  return run;
}

bool starts_directors(const Options& options, const scene::Scene& scene) {
  return options.starts_all_directors ||
         (!options.starts_no_directors && std::ranges::any_of(scene.directors, has_program));
}

void check_programs(const scene::Scene& scene) {
  std::vector<scene::Problem> problems;
  for (const scene::Director& director : scene.directors) {
    if (has_program(director)) continue;
    problems.push_back(
        {scene::Problem::Severity::fault, scene::file_of(scene, director.where), director.where,
         fmt::format(
             "director '{}' has no program that can be started; write script=\"FILE.lua\" or "
             "command=\"PROGRAM\", or remove it",
             director.id)});
  }
  if (!problems.empty()) throw scene::SceneError(std::move(problems));
}

unsigned threads_for(const Options& options, std::span<const scene::Entity> entities) {
  constexpr unsigned bodies_of_a_thread = 32;  // measured: docs/performance.md
  if (options.threads > 0) return options.threads;
  const auto moving = std::ranges::count(entities, true, &scene::Entity::movable);
  const unsigned most = std::min(std::thread::hardware_concurrency(), 256U);
  return std::clamp(static_cast<unsigned>(moving) / bodies_of_a_thread, 1U, std::max(most, 1U));
}

unsigned lua_processes_for(const Options& options, unsigned threads, std::size_t robots) {
  constexpr std::size_t robots_of_a_process = 64;  // measured: docs/performance.md
  const auto most = static_cast<unsigned>(std::max<std::size_t>(1, robots / robots_of_a_process));
  return options.lua_processes.value_or(std::min(threads, most));
}

wire::End end_message(const reports::Summary& summary) {
  using reports::Ending;
  wire::End end;
  end.tick = summary.ticks;
  end.message = summary.vanished;
  switch (summary.ending) {
    case Ending::finished:
      end.reason = wire::EndReason::finished;
      if (summary.result) end.message = summary.result->text;
      break;
    case Ending::shut_down:
      end.reason = wire::EndReason::finished;
      end.message = summary.shutdown_reason;
      break;
    case Ending::interrupted:
    case Ending::forced:
    case Ending::reset:  // no run ends like that
      end.reason = wire::EndReason::interrupted;
      break;
    case Ending::controller_vanished:
    case Ending::failed_fast:
    case Ending::deadline_missed:
      end.reason = wire::EndReason::failed;
      break;
  }
  return end;
}

LiveView::Run shown(supervision::World& world, network::Server& server,
                    supervision::Callers& callers, supervision::Supervision& supervision,
                    Schedule& schedule, const reports::Summary& summary, std::uint64_t last_tick) {
  LiveView::Run watched{world, schedule, last_tick, {}, {}, {}, {}, {}, {}, {}};
  watched.connect = [&callers](supervision::LocalCalls calls) { callers.add(std::move(calls)); };
  watched.changes = [&callers] { return callers.changes(); };
  watched.is_paused = [&server] { return server.pause() == network::Pause::halted; };
  watched.paused_for = [&supervision] { return supervision.paused_for(); };
  watched.status = [&supervision] { return supervision.status(); };
  watched.metrics = [&summary]() -> const auto& { return summary.metrics; };
  watched.controllers = [&server] { return server.performance().controllers; };
  return watched;
}

std::unique_ptr<LiveView> make_showing(const Options& options, const LiveView::Run& run) {
  if (!options.view) return nullptr;
  auto live_view = std::make_unique<LiveView>(options, run);
  const std::string page = live_view->page_address(), viewer = live_view->viewer_address();
  const auto host = text::note_of_every_host(live_view->host());
  const std::string note = host.empty() ? "" : "ziggurat: " + host + "\n";
  const std::string text = options.json
                               ? reports::json_text({{"view", page}, {"viewer", viewer}}) + "\n"
                               : "ziggurat: watch this run at " + page +
                                     "\nziggurat: or open a Foxglove WebSocket connection to " +
                                     viewer + "\n" + note;
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text.data(), text.size());
  return live_view;
}

void end_while_loading() {
  constexpr std::string_view text = "ziggurat: interrupted while loading\n";
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text.data(), text.size());
  std::_Exit(reports::exit_code::interrupted);
}

}  // namespace ziggurat::run
