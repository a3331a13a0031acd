#include "run/client_options.h"

#include <fmt/format.h>

#include <algorithm>

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

}  // namespace ziggurat::run
