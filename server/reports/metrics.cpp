// SPDX-License-Identifier: MIT
#include "reports/metrics.h"

#include <fmt/format.h>

#include <chrono>
#include <mutex>
#include <optional>
#include <string_view>

#include "http/port.h"
#include "text/numbers.h"

namespace ziggurat::reports {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds period{250};  // between copies

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '\\' || c == '"') out += '\\';
    if (c == '\n') {
      out += "\\n";
    } else {
      out += c;
    }
  }
  return out + '"';
}

void head(std::string& out, std::string_view name, std::string_view type, std::string_view help) {
  out += fmt::format("# HELP {0} {2}\n# TYPE {0} {1}\n", name, type, help);
}

const char* name_of(wire::SessionStatus::State state) {
  constexpr const char* names[] = {"unspecified", "ready",    "owing", "answered",
                                   "paused",      "draining", "lost"};
  return names[static_cast<std::size_t>(state)];
}

std::string label_of(const wire::SessionStatus& session, std::size_t number) {
  return fmt::format("session=\"{}\",client={}", number, quoted(session.client));
}

void add_sessions(std::string& out, const wire::Status& status) {
  const auto each = [&](auto write) {
    for (std::size_t i = 0; i < status.sessions.size(); ++i) {
      write(status.sessions[i], label_of(status.sessions[i], i));
    }
  };
  head(out, "ziggurat_session_state", "gauge", "1 for the state that a session is in.");
  each([&](const wire::SessionStatus& session, const std::string& label) {
    out +=
        fmt::format("ziggurat_session_state{{{},state=\"{}\"}} 1\n", label, name_of(session.state));
  });
  head(out, "ziggurat_session_waiting_seconds", "gauge",
       "For how long the world has waited for a session.");
  each([&](const wire::SessionStatus& session, const std::string& label) {
    out +=
        fmt::format("ziggurat_session_waiting_seconds{{{}}} {}\n", label, session.wall_waiting_s);
  });
  head(out, "ziggurat_session_latency_seconds", "gauge",
       "From observation to command, over the last 1000 ticks.");
  each([&](const wire::SessionStatus& session, const std::string& label) {
    const auto& latency = session.latency;
    for (const auto& [quantile, value] :
         {std::pair{"0.5", latency.p50}, {"0.99", latency.p99}, {"1", latency.max}}) {
      out += fmt::format("ziggurat_session_latency_seconds{{{},quantile=\"{}\"}} {}\n", label,
                         quantile, value);
    }
  });
  head(out, "ziggurat_session_deadline_misses_total", "counter", "Deadlines missed.");
  each([&](const wire::SessionStatus& session, const std::string& label) {
    out += fmt::format("ziggurat_session_deadline_misses_total{{{}}} {}\n", label, session.misses);
  });
}

}  // namespace

std::string to_prometheus(const wire::Status& status) {
  std::string out;
  const auto gauge = [&](std::string_view name, std::string_view help, auto value) {
    head(out, name, "gauge", help);
    out += fmt::format("{} {}\n", name, value);
  };
  head(out, "ziggurat_tick", "counter", "Ticks of the world.");
  out += fmt::format("ziggurat_tick {}\n", status.tick);
  gauge("ziggurat_simulated_seconds", "Simulated time.",
        static_cast<double>(status.time_ns) * 1e-9);
  gauge("ziggurat_paused", "1 if the world is paused.",
        status.phase == wire::Status::Phase::paused ? 1 : 0);
  gauge("ziggurat_free_robots", "Robots without a session that the world waits for.",
        status.free_robots.size());
  gauge("ziggurat_gone_robots", "Robots that have no controller any more.",
        status.gone_robots.size());
  gauge("ziggurat_uptime_seconds", "Wall time since the start.", status.wall_uptime_s);
  add_sessions(out, status);
  if (status.solver.islands > 0) {
    gauge("ziggurat_solver_islands", "Islands of bodies that touch, solved since the world began.",
          status.solver.islands);
    gauge("ziggurat_solver_not_converged", "Islands for which the solver did not converge.",
          status.solver.not_converged);
    gauge("ziggurat_solver_worst_residual",
          "Largest violation of the laws of contact [m/s or rad/s].", status.solver.worst_residual);
  }
  if (!status.metrics.empty()) {
    head(out, "ziggurat_metric", "gauge", "What controllers have measured last.");
  }
  for (const world::Metric& metric : status.metrics) {
    out += fmt::format("ziggurat_metric{{robot={},name={}}} {}\n", quoted(metric.robot),
                       quoted(metric.name), metric.value);
  }
  head(out, "ziggurat_tick_phase_seconds", "gauge",
       "Where the wall time of a tick goes, over the last 1000 ticks.");
  for (const auto& phase : status.budget) {
    for (const auto& [quantile, value] :
         {std::pair{"0.5", phase.wall.p50}, {"0.99", phase.wall.p99}, {"1", phase.wall.max}}) {
      out += fmt::format("ziggurat_tick_phase_seconds{{phase=\"{}\",quantile=\"{}\"}} {}\n",
                         phase.phase, quantile, value);
    }
  }
  return out;
}

struct MetricsPort::State {
  std::string url;
  Clock::time_point published{};
  std::mutex mutex;  // of the next two
  std::string prometheus, json;
  std::optional<http::Port> port;  // last: its thread ends first

  http::Answer read(std::string_view path) {
    const std::lock_guard lock(mutex);
    if (path == "/metrics")
      return {200, "text/plain; version=0.0.4; charset=utf-8", {}, prometheus};
    if (path == "/status") return {200, "application/json", {}, json};
    if (path == "/") {
      return {200, "text/plain", {}, "Ziggurat: /metrics for Prometheus, /status for JSON\n"};
    }
    return {404, "text/plain", {}, "404: there are /metrics and /status.\n"};
  }
};

MetricsPort::MetricsPort(const std::string& address, bool insecure)
    : state_(std::make_unique<State>()) {
  const http::Address place = http::to_address("--metrics", address);
  if (!insecure && !http::is_loopback(place.host)) {
    throw text::UsageError(fmt::format(
        "--metrics: other machines can reach {}; use 127.0.0.1, or add --insecure", place.host));
  }
  State& state = *state_;
  // Other machines may know this one by any name.
  state.port.emplace(
      "--metrics", place, [&state](std::string_view path) { return state.read(path); },
      http::PortOptions{.any_host = insecure});
  state.url =
      fmt::format("http://{}:{}", address.substr(0, address.rfind(':')), state.port->number());
}

MetricsPort::~MetricsPort() = default;

const std::string& MetricsPort::url() const { return state_->url; }

bool MetricsPort::needs_update() const { return Clock::now() - state_->published >= period; }

void MetricsPort::publish(const wire::Status& status) {
  state_->published = Clock::now();
  std::string prometheus = to_prometheus(status);
  std::string json = wire::to_json(status);
  const std::lock_guard lock(state_->mutex);
  state_->prometheus.swap(prometheus);
  state_->json.swap(json);
}

}  // namespace ziggurat::reports
