// SPDX-License-Identifier: MIT
#include "cli/supervision_client.h"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "run/build.h"
#include "ziggurat/session.h"

namespace ziggurat::cli {
namespace {

constexpr std::size_t robots_named = 3;

std::string some_of(const std::vector<std::string>& robots) {
  std::string text;
  for (std::size_t i = 0; i < robots.size() && i < robots_named; ++i) {
    text += (i == 0 ? "" : ", ") + robots[i];
  }
  if (robots.size() > robots_named)
    text += fmt::format(" and {} more", robots.size() - robots_named);
  return text;
}

std::string duration(double seconds) {
  if (seconds <= 0) return "-";
  if (seconds < 1e-3) return fmt::format("{:.0f} us", seconds * 1e6);
  if (seconds < 1) return fmt::format("{:.1f} ms", seconds * 1e3);
  if (seconds < 120) return fmt::format("{:.1f} s", seconds);
  return fmt::format("{:.0f} min", seconds / 60);
}

/// Robots or director of a session.
std::string part_of(const SessionStatus& session) {
  return session.director.empty() ? some_of(session.robots)
                                  : fmt::format("director '{}'", session.director);
}

std::string waited_for(const ServerStatus& status) {
  std::string text;
  for (const SessionStatus& session : status.sessions) {
    if (session.state != "owing") continue;
    text += fmt::format("\nwaiting for {} ({}) for {}", session.client, part_of(session),
                        duration(session.waiting));
  }
  if (!status.free_robots.empty()) {
    text += fmt::format("\nwaiting for a client to connect for {}", some_of(status.free_robots));
  }
  for (const std::string& director : status.free_directors) {
    text += fmt::format("\nwaiting for a client to connect for director '{}'", director);
  }
  return text;
}

}  // namespace

void add_key_options(boost::program_options::options_description& options) {
  namespace po = boost::program_options;
  options.add_options()("server-key", po::value<std::string>()->value_name("KEY"),
                        "the server's public key, if its endpoint is protected")(
      "curve-secret", po::value<std::string>()->value_name("FILE"),
      "with --server-key: the secret key of this client ('ziggurat keygen')");
}

std::string take_endpoint(std::vector<std::string>& words) {
  const bool is_given = !words.empty() && words.front().find("://") != std::string::npos;
  if (!is_given) return ziggurat::Options::from_environment().endpoint;
  std::string endpoint = words.front();
  words.erase(words.begin());
  return endpoint;
}

SupervisorOptions supervisor_options(const std::string& endpoint,
                                     const boost::program_options::variables_map& values,
                                     std::string name) {
  const auto value = [&](const char* option) {
    return values.count(option) > 0 ? values[option].as<std::string>() : std::string();
  };
  SupervisorOptions options;
  options.server_key = value("server-key");
  options.curve_secret = value("curve-secret");
  options.endpoint = endpoint;
  options.name = std::move(name);
  options.version = run::version;
  return options;
}

std::unique_ptr<Supervisor> connect(SupervisorOptions options, reports::Console& console) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds noticeable{500};
  const auto says_more = std::make_shared<bool>(true);
  const auto begin = Clock::now();
  const std::string text =
      fmt::format("nothing answers at {} yet; trying for {:.0f} s", options.endpoint,
                  std::chrono::duration<double>(options.connect_timeout).count());
  options.is_interrupted = [=, &console, is_interrupted = std::move(options.is_interrupted)] {
    if (is_interrupted && is_interrupted()) return true;
    if (Clock::now() - begin > noticeable && std::exchange(*says_more, false)) {
      console.notice(text);
      console.offer();
    }
    return false;
  };
  auto server = std::make_unique<Supervisor>(options);
  *says_more = false;
  return server;
}

std::string to_text(const ServerStatus& status) {
  const double seconds = std::chrono::duration<double>(status.time).count();
  std::string text =
      fmt::format("{}: {}, tick {}{} ({:.1f} s), seed {}, up {}", status.scene, status.phase,
                  status.tick, status.last_tick ? fmt::format(" of {}", status.last_tick) : "",
                  seconds, status.seed, duration(status.uptime));
  if (status.hardware_in_the_loop) text += ", hardware in the loop";
  text += waited_for(status);
  text +=
      fmt::format("\n\n{:<28} {:<10} {:<9} {:>8} {:>9} {:>9} {:>9} {:>7}  {:<18} {}", "client",
                  "role", "state", "tick", "waiting", "p50", "p99", "misses", "deadline", "robots");
  for (const SessionStatus& s : status.sessions) {
    text +=
        fmt::format("\n{:<28.28} {:<10} {:<9} {:>8} {:>9} {:>9} {:>9} {:>7}  {:<18} {}", s.client,
                    s.role, s.state, s.tick, duration(s.waiting), duration(s.latency.p50),
                    duration(s.latency.p99), s.misses, s.policy, part_of(s));
  }
  if (!status.gone_robots.empty()) {
    text += fmt::format("\n\nwithout controller from now on: {}", some_of(status.gone_robots));
  }
  if (const auto& solver = status.solver; solver.islands > 0) {
    text += fmt::format(
        "\n\nsolver: {} islands, {} did not converge, the worst residual is {:.2g} m/s or rad/s",
        solver.islands, solver.not_converged, solver.worst_residual);
  }
  if (!status.budget.empty()) text += "\n\na tick's wall time:";
  for (const ServerStatus::Phase& phase : status.budget) {
    text +=
        fmt::format("\n  {:<10} p50 {:>9}   p99 {:>9}   max {:>9}", phase.name,
                    duration(phase.wall.p50), duration(phase.wall.p99), duration(phase.wall.max));
  }
  return text;
}

}  // namespace ziggurat::cli
