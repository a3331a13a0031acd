// SPDX-License-Identifier: MIT
#include "run/options/option_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "network/glob.h"
#include "processes/scripts.h"
#include "text/numbers.h"

namespace ziggurat::run {
namespace {

bool drops(const network::Config::Deadline& deadline) {
  using enum scene::DeadlineAction;
  const scene::DeadlinePolicy& policy = deadline.policy;
  return policy.action == drop ||
         ((policy.action == hold || policy.action == zero) && policy.miss_budget > 0);
}

[[noreturn]] void refuse_option(const char* option, const char* why, const char* instead) {
  throw text::UsageError(
      fmt::format("{} has no effect: {}; write {} too, or leave it out", option, why, instead));
}

/// Patterns that match none of the names.
std::vector<std::string> without_effect(const std::vector<std::string>& patterns,
                                        const std::vector<std::string>& names) {
  std::vector<std::string> found;
  for (const std::string& pattern : patterns) {
    const network::Glob glob(pattern);
    const auto means = [&](const std::string& name) {
      return name == pattern || glob.matches(name);
    };
    if (std::ranges::none_of(names, means)) found.push_back(pattern);
  }
  return found;
}

}  // namespace

ExpectedClients expected_clients(const Options& options, const scene::Scene& scene, bool is_serve,
                                 bool with_controllers) {
  const auto has_command = [](const scene::Director& director) {
    return !director.command.empty();
  };
  const bool starts_programs =
      !std::ranges::all_of(scene.controllers, processes::runs_script) ||
      std::ranges::any_of(scene.directors, has_command) ||
      std::ranges::find(options.lua_arguments, "--trust-scripts") != options.lua_arguments.end();
  return {is_serve || !options.endpoints.empty() || (with_controllers && starts_programs),
          with_controllers && !scene.directors.empty()};
}

void check_client_options(const Options& options, const ExpectedClients& clients,
                          const network::Config& config) {
  if (clients.can_connect) return;
  constexpr const char* none =
      "the run has no endpoint and starts Lua scripts at most, so that no client can connect";
  if (!options.snapshot_folder.empty()) refuse_option("--snapshot-folder", none, "--endpoint URL");
  if (options.allows_directors) refuse_option("--allow-director", none, "--endpoint URL");
  if (!options.spawned_script_folders.empty() && !clients.has_directors && !options.view) {
    refuse_option("--allow-spawned-scripts",
                  "neither a client nor a director or viewer can spawn robots in this run",
                  "--endpoint URL or --view");
  }
  if (options.allow_drops && std::ranges::none_of(config.deadlines, drops)) {
    refuse_option("--allow-drops", "no deadline of this run drops a robot",
                  "--deadline drop:1000, for example,");
  }
}

void check_gate(const std::vector<reports::Condition>& gate, const GateContext& context) {
  const bool waits_for_all = !context.deadlines.empty() &&
                             std::ranges::all_of(context.deadlines, [](const auto& deadline) {
                               return deadline.policy.action == scene::DeadlineAction::wait;
                             });
  for (const reports::Condition& condition : gate) {
    if (condition.subject == reports::Condition::Subject::late && !context.is_paced) {
      throw text::UsageError(fmt::format(
          "--gate: '{}' is always met: nothing paces the run, so no tick is late; add --hil or "
          "--real-time, or leave it out",
          condition.text));
    }
    if (reports::is_of_misses(condition.subject) && waits_for_all && !context.may_be_asked) {
      throw text::UsageError(fmt::format(
          "--gate: '{}' is always met: the world waits for every controller; add --hil, or "
          "--deadline hold:50 for example, or leave it out",
          condition.text));
    }
  }
}

std::vector<std::string> doubts_of(const std::vector<network::ClientKey>& clients,
                                   const scene::Scene& scene, const world::Layout& layout) {
  std::vector<std::string> robots, controllers, doubts;
  for (const auto& robot : layout.robots) robots.push_back(robot.id);
  for (const auto& controller : scene.controllers) controllers.push_back(controller.id);
  for (const network::ClientKey& client : clients) {
    const auto doubt = [&](const char* limit, const char* what,
                           const std::vector<std::string>& patterns) {
      if (patterns.empty()) return;
      doubts.push_back(fmt::format("--curve-clients: {}={} of the key {} means no {} of the scene",
                                   limit, fmt::join(patterns, ","),
                                   client.name.empty() ? client.public_key : client.name, what));
    };
    doubt("robots", "robot", without_effect(client.scope.robots, robots));
    doubt("controllers", "controller", without_effect(client.scope.controllers, controllers));
  }
  return doubts;
}

}  // namespace ziggurat::run
