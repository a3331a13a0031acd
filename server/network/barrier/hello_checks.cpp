// SPDX-License-Identifier: MIT
#include "network/barrier/hello_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <unordered_map>

#include "network/barrier/departure.h"
#include "network/barrier/peer_messages.h"
#include "network/glob.h"
#include "network/keys.h"
#include "wire/devices.h"
#include "wire/messages.h"

namespace ziggurat::network {

using scene::DeadlineAction;
using wire::ErrorCode;

namespace {

/// A robot that a Hello selects. Those named by id must be there for the taking; those that only
/// fit a pattern are passed over if they have left.
struct Selected {
  std::size_t robot = 0;  ///< into Layout::robots
  bool by_id = false;
};

using wire::make_fault;

enum class Fit { none, by_pattern, by_id };

/// Match of each robot of the layout with the ids and patterns.
std::variant<std::vector<Fit>, wire::Fault> fit_names(const std::vector<std::string>& names,
                                                      const world::Layout& layout) {
  std::vector<Fit> fits(layout.robots.size(), names.empty() ? Fit::by_pattern : Fit::none);
  std::unordered_map<std::string_view, std::size_t> positions;
  for (std::size_t i = 0; i < layout.robots.size(); ++i) positions[layout.robots[i].id] = i;
  std::size_t globs = 0;
  for (const std::string& name : names) {
    if (const auto found = positions.find(name); found != positions.end()) {
      fits[found->second] = Fit::by_id;
      continue;
    }
    if (!has_wildcards(name)) {
      const std::string id = name.substr(0, longest_pattern);
      return make_fault(ErrorCode::unknown_robot, "robots",
                        fmt::format("The scene has no robot '{}'.", id), id);
    }
    if (name.size() > longest_pattern || ++globs > most_patterns) {
      return make_fault(ErrorCode::too_many, "robots",
                        fmt::format("A Hello may have {} patterns of {} bytes at most.",
                                    most_patterns, longest_pattern));
    }
    const Glob glob(name);
    for (std::size_t i = 0; i < fits.size(); ++i) {
      if (fits[i] == Fit::none && glob.matches(layout.robots[i].id)) fits[i] = Fit::by_pattern;
    }
  }
  return fits;
}

/// Robots of a Hello in scene order, or the fault of its criteria.
std::variant<std::vector<Selected>, wire::Fault> select_robots(const wire::Hello& hello,
                                                               const wire::Run& run) {
  if (hello.robots.empty() && hello.controller.empty() && !hello.lua_only) {
    return make_fault(ErrorCode::bad_value, "robots",
                      "A Hello says which robots it wants; '*' in `robots` is all of them.");
  }
  const auto is_wanted = [&](const scene::Controller& controller) {
    return controller.id == hello.controller;
  };
  if (!hello.controller.empty() &&
      std::none_of(run.controllers.begin(), run.controllers.end(), is_wanted)) {
    return make_fault(ErrorCode::unknown_controller, "controller",
                      fmt::format("The scene has no controller '{}'.",
                                  hello.controller.substr(0, longest_pattern)));
  }
  auto fitted = fit_names(hello.robots, run.layout);
  if (auto* fault = std::get_if<wire::Fault>(&fitted)) return std::move(*fault);
  const auto& fits = std::get<std::vector<Fit>>(fitted);
  std::vector<Selected> selected;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    const scene::Controller& controller = run.controllers[run.layout.robots[i].controller];
    if (fits[i] == Fit::none) continue;
    if (!hello.controller.empty() && !is_wanted(controller)) continue;
    if (hello.lua_only && !controller.lua) continue;
    selected.push_back({i, fits[i] == Fit::by_id});
  }
  if (selected.empty()) {
    return make_fault(ErrorCode::unknown_robot, "robots",
                      run.layout.robots.empty()
                          ? "The scene has no robots: no entity has a controller."
                          : "No robot of the scene fits what the Hello asks for.");
  }
  return selected;
}

wire::Refusal refuse_robot(const std::string& id, ErrorCode code, std::string message) {
  auto refusal = make_refusal(code, "robots", std::move(message));
  refusal.fault.robot = id;
  return refusal;
}

wire::Refusal refuse_taken(const std::string& id, const Session& by, std::string message) {
  auto refusal = refuse_robot(id, ErrorCode::robot_taken, std::move(message));
  refusal.fault.retryable = true;
  refusal.holder = by.client;
  return refusal;
}

/// Scope of the connection's key; null: it has no key.
const Scope* scope_of(const Barrier& barrier, const Access& access) {
  if (!access.key || !barrier.config.curve) return nullptr;
  return &barrier.config.curve->clients[*access.key].scope;
}

bool is_in_scope(const Barrier& barrier, const std::optional<ScopeGlobs>& scope,
                 std::size_t robot) {
  if (!scope) return true;
  const auto& layout = barrier.run->layout.robots[robot];
  return scope->includes(layout.id, barrier.run->controllers[layout.controller].id);
}

/// The robots of a selection that the connection may have and that have not left. Those named by id
/// stay, whatever they are; otherwise refuses one that the key does not include.
std::variant<std::vector<std::size_t>, wire::Refusal> allowed_robots(
    const Barrier& barrier, const std::vector<Selected>& selection, const Scope* scope) {
  std::optional<ScopeGlobs> globs;
  if (scope != nullptr) globs.emplace(*scope);
  std::vector<std::size_t> robots;
  bool has_any = false;
  for (const auto& [robot, by_id] : selection) {
    if (!is_in_scope(barrier, globs, robot)) {
      if (!by_id) continue;
      const std::string& id = barrier.run->layout.robots[robot].id;
      return refuse_robot(id, ErrorCode::forbidden,
                          fmt::format("The key of this connection may not drive robot '{}'.", id));
    }
    has_any = true;
    if (by_id || !barrier.ownership[robot].has_left) robots.push_back(robot);
  }
  if (!has_any) {
    return make_refusal(ErrorCode::forbidden, "robots",
                        "The key of this connection may drive none of the robots asked for.");
  }
  if (robots.empty()) {
    return make_refusal(ErrorCode::not_yours, "robots", "All robots asked for have left the run.");
  }
  return robots;
}

/// Why a robot can't be taken, if it can't.
std::optional<wire::Refusal> check_robot(Barrier& barrier, std::size_t robot, bool is_takeover) {
  const std::string& id = barrier.run->layout.robots[robot].id;
  if (barrier.ownership[robot].has_left) {
    return refuse_robot(id, ErrorCode::not_yours,
                        fmt::format("Robot '{}' has left the run for good.", id));
  }
  if (is_takeover) return std::nullopt;
  Session* holder = barrier.sessions.find(barrier.ownership[robot].holder);
  if (holder != nullptr && is_reachable(barrier, *holder)) {
    return refuse_taken(id, *holder,
                        fmt::format("Robot '{}' is driven by {}.", id, holder->client));
  }
  const Session* claimant = barrier.sessions.find(barrier.ownership[robot].claimant);
  if (claimant == nullptr || barrier.now >= claimant->lease_end) return std::nullopt;
  const std::chrono::duration<double> rest = claimant->lease_end - barrier.now;
  return refuse_taken(id, *claimant,
                      fmt::format("Robot '{}' is kept for {}, which is lost, for {:.1f} s more.",
                                  id, claimant->client, rest.count()));
}

/// Whether the world may wait longer by a policy than by another.
bool waits_longer(const scene::DeadlinePolicy& policy, const scene::DeadlinePolicy& than) {
  if (than.action == DeadlineAction::wait) return false;
  return policy.action == DeadlineAction::wait || policy.wall_deadline_ms > than.wall_deadline_ms;
}

}  // namespace

bool is_reachable(Barrier& barrier, Session& session) {
  barrier.outbox.heartbeat(++barrier.heartbeats);
  if (send(barrier, session) != Delivery::unreachable) return true;
  lose(barrier, session, "its connection is gone");
  return false;
}

wire::Refusal make_refusal(ErrorCode code, std::string field, std::string message) {
  return {wire::make_fault(code, std::move(field), std::move(message)), {}, {}};
}

std::optional<wire::Refusal> check_hello(const Barrier& barrier, const wire::Hello& hello,
                                         const Roles& roles) {
  if (hello.version.major == 0) {
    return make_refusal(
        ErrorCode::version_mismatch, "version",
        fmt::format("The Hello has no major version of the protocol; write the one of the client, "
                    "as {}.{}, the server's.",
                    wire::version.major, wire::version.minor));
  }
  if (hello.version.major != wire::version.major) {
    return make_refusal(
        ErrorCode::version_mismatch, "version",
        fmt::format("The client speaks version {}.{} of the protocol, the server {}.{}.",
                    hello.version.major, hello.version.minor, wire::version.major,
                    wire::version.minor));
  }
  const bool is_director =
      hello.role == wire::Role::director && hello.version.minor >= wire::minor_with_directors;
  const bool is_role = hello.role == wire::Role::controller || is_director ||
                       hello.role == wire::Role::supervisor || hello.role == wire::Role::observer;
  if (!is_role) return make_refusal(ErrorCode::bad_value, "role", "A Hello must name its role.");
  if (!roles.allow(hello.role)) {
    return make_refusal(ErrorCode::forbidden, "role",
                        "The key of this connection has another role.");
  }
  if (barrier.gate.is_held(TickGate::Hold::finished)) {
    return make_refusal(ErrorCode::out_of_state, {}, "The run is over.");
  }
  return check_places(barrier, hello.role);
}

std::optional<wire::Refusal> check_places(const Barrier& barrier, wire::Role role) {
  const Config& config = barrier.config;
  const auto [most, name] =
      role == wire::Role::controller   ? std::pair(config.max_sessions, "controllers")
      : role == wire::Role::supervisor ? std::pair(config.max_supervisors, "supervisors")
      : role == wire::Role::director   ? std::pair(config.max_directors, "directors")
                                       : std::pair(config.max_observers, "observers");
  const std::size_t connected = barrier.sessions.connected(role);
  if (connected < most) return std::nullopt;
  auto refusal = make_refusal(
      ErrorCode::too_many, {},
      fmt::format("The server has {} sessions of {} and takes no more.", connected, name));
  refusal.fault.retryable = true;
  return refusal;
}

std::optional<wire::Refusal> check_policy(const Barrier& barrier, const wire::Hello& hello,
                                          std::span<const std::size_t> robots) {
  if (!hello.deadline) return std::nullopt;
  const auto& requested = *hello.deadline;
  if (requested.action < scene::DeadlineAction::wait ||
      requested.action > scene::DeadlineAction::stop) {
    return make_refusal(ErrorCode::bad_value, "deadline_policy.action",
                        "The deadline policy has no action that this protocol knows.");
  }
  if (requested.action != scene::DeadlineAction::wait && requested.wall_deadline_ms == 0) {
    return make_refusal(ErrorCode::bad_value, "deadline_policy.wall_deadline_ms",
                        "A deadline policy other than WAIT must have a deadline of at least 1 ms.");
  }
  for (const std::size_t robot : robots) {
    const auto fixed = barrier.deadlines.fixed_against(robot, requested);
    if (!fixed) continue;
    const auto& layout = barrier.run->layout.robots[robot];
    auto refusal =
        make_refusal(ErrorCode::forbidden, "deadline_policy",
                     fmt::format("The deadline policy of controller '{}' is fixed: {}.",
                                 barrier.run->controllers[layout.controller].id, to_text(*fixed)));
    refusal.fault.robot = layout.id;
    return refusal;
  }
  return std::nullopt;
}

std::optional<wire::Refusal> check_power(const Barrier& barrier, const wire::Hello& hello,
                                         const Access& access,
                                         std::span<const std::size_t> robots) {
  if (!hello.deadline || access.roles.supervisor) return std::nullopt;
  const scene::DeadlinePolicy& requested = *hello.deadline;
  for (const std::size_t robot : robots) {
    const scene::DeadlinePolicy& policy = barrier.deadlines.policy(robot);
    if (requested.action == DeadlineAction::stop && policy.action != DeadlineAction::stop) {
      return make_refusal(
          ErrorCode::forbidden, "deadline_policy.action",
          "The policy STOP can end the run, which the key of this connection may not: it lacks "
          "the role `supervisor`.");
    }
    const scene::DeadlinePolicy& usual = barrier.deadlines.usual_policy(robot);
    if (requested == policy || !waits_longer(requested, usual)) continue;
    return make_refusal(
        ErrorCode::forbidden, "deadline_policy",
        fmt::format(
            "The world waits for robot '{}' by {}, and a key without the role `supervisor` may not "
            "let it wait longer.",
            barrier.run->layout.robots[robot].id, to_text(usual)));
  }
  return std::nullopt;
}

std::optional<wire::Refusal> check_takeover(const Barrier& barrier, const wire::Hello& hello,
                                            const Access& access) {
  const Scope* scope = scope_of(barrier, access);
  if (!hello.takeover || scope == nullptr || scope->may_take_over) return std::nullopt;
  return make_refusal(ErrorCode::forbidden, "takeover",
                      "The key of this connection may take nothing over from others.");
}

std::variant<std::vector<std::size_t>, wire::Refusal> grant_robots(Barrier& barrier,
                                                                   const wire::Hello& hello,
                                                                   const Access& access) {
  const Scope* scope = scope_of(barrier, access);
  auto selection = select_robots(hello, *barrier.run);
  if (auto* fault = std::get_if<wire::Fault>(&selection)) {
    return wire::Refusal{std::move(*fault), {}, {}};
  }
  auto allowed = allowed_robots(barrier, std::get<std::vector<Selected>>(selection), scope);
  if (auto* refusal = std::get_if<wire::Refusal>(&allowed)) return std::move(*refusal);
  if (auto refusal = check_takeover(barrier, hello, access)) return std::move(*refusal);
  const auto& robots = std::get<std::vector<std::size_t>>(allowed);
  if (auto refusal = check_policy(barrier, hello, robots)) return std::move(*refusal);
  if (auto refusal = check_power(barrier, hello, access, robots)) return std::move(*refusal);
  for (const std::size_t robot : robots) {
    if (auto refusal = check_robot(barrier, robot, hello.takeover)) return std::move(*refusal);
  }
  // At last: this takes as long as the Welcome itself.
  if (!wire::fit_into_welcome(*barrier.run, robots)) {
    return make_refusal(ErrorCode::too_large, "robots",
                        fmt::format("A Welcome with these {} robots would have more than 64 MiB: "
                                    "ask for fewer in each session "
                                    "(--lua-processes for scripts).",
                                    robots.size()));
  }
  return robots;
}

}  // namespace ziggurat::network
