// Cost of a director that reads the poses of 1 000 robots at each tick: ticks with and without it,
// by turns, in one world. The director is a process of its own, on the C++ client. Wall time.
//
// usage: bench_directing [TICKS] [ROBOTS]

#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "network/server.h"
#include "scene/reader.h"
#include "simulation/simulation.h"
#include "ziggurat/director.h"

namespace {

using namespace ziggurat;
using Clock = std::chrono::steady_clock;

int direct(const std::string& endpoint) {
  DirectorOptions options;
  options.endpoint = endpoint;
  options.director = "reader";
  Director director(options);
  double sum = 0;
  while (director.next()) {
    for (const Entity* entity : director.entities()) sum += entity->pose().position[0];
  }
  return std::isfinite(sum) ? 0 : 1;
}

std::string scene_text(int robots) {
  std::string text =
      R"(<argos-configuration><framework><experiment ticks_per_second="10" random_seed="1"/></framework>)"
      R"(<controllers><external_controller id="c"><actuators><differential_steering implementation="default"/>)"
      R"(</actuators><sensors><footbot_proximity implementation="default"/></sensors><params/></external_controller>)"
      R"(</controllers><arena size="100,100,2">)";
  const int side = static_cast<int>(std::ceil(std::sqrt(robots)));
  for (int i = 0; i < robots; ++i) {
    text += fmt::format(
        R"(<foot-bot id="r{}"><body position="{},{},0"/><controller config="c"/></foot-bot>)", i,
        0.6 * (i % side) - 0.3 * side, 0.6 * (i / side) - 0.3 * side);
  }
  return text +
         R"(</arena><physics_engines><dynamics3d id="d" iterations="10"><gravity g="9.8"/><floor/>)"
         R"(</dynamics3d></physics_engines><media/></argos-configuration>)";
}

double median(std::vector<double>& values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

pid_t start_director(const std::string& endpoint) {
  const pid_t pid = ::fork();
  if (pid != 0) return pid;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::execl("/proc/self/exe", "bench_directing", "direct", endpoint.c_str(), nullptr);
  ::_exit(127);
}

int measure(int ticks, int robots) {
  const auto read = scene::read_text(scene_text(robots), "bench", {});
  if (!read.ok()) throw scene::SceneError(read.problems);
  simulation::Simulation simulation(read.scene, {1, {}});
  network::Config config;
  config.endpoints = {"ipc://@ziggurat-bench-" + std::to_string(::getpid())};
  config.allows_directors = true;
  network::Server server(
      config, {simulation.layout(), read.scene.controllers, {}, 1, 100'000'000, 10, "", "bench"});
  std::vector<std::size_t> all(static_cast<std::size_t>(robots));
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  server.remove_robots(all);
  const pid_t director = start_director(server.endpoints().front());
  network::ServerDirectors directors(server);
  while (directors.status().empty())
    server.linger(simulation.commands(), {std::chrono::milliseconds(20), {}});
  for (auto& wheels : simulation.commands().wheels) wheels = {0.1, 0.05};
  const wire::Truth truth{simulation.layout(), simulation.entities(), simulation.state(),
                          simulation.observations(), simulation.contacts()};
  world::Commands unused = simulation.commands();
  std::vector<double> with, without, exchanges;
  using Milliseconds = std::chrono::duration<double, std::milli>;
  for (int tick = 0; tick < 2 * ticks; ++tick) {
    const bool is_told = tick % 2 == 0;
    const auto begin = Clock::now();
    if (is_told) {
      server.publish(simulation.observations(), simulation.state().tag_payloads, &truth);
      while (server.collect(unused, {}) != network::Outcome::complete) continue;
      exchanges.push_back(Milliseconds(Clock::now() - begin).count());
    }
    simulation.step();
    const Milliseconds time = Clock::now() - begin;
    (is_told ? with : without).push_back(time.count());
  }
  server.finish({wire::EndReason::finished, "", simulation.state().tick});
  server.drain({std::chrono::seconds(5), {}});
  int status = 0;
  ::waitpid(director, &status, 0);
  const double told = median(with), alone = median(without);
  fmt::print(
      "{} robots, medians of {} ticks: {:.3f} ms without, {:.3f} ms with a director ({:+.1f} %), "
      "of "
      "which the exchange takes {:.3f} ms ({:.1f} % of a tick)\n",
      robots, ticks, alone, told, 100 * (told / alone - 1), median(exchanges),
      100 * median(exchanges) / alone);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc == 3 && std::string(argv[1]) == "direct") return direct(argv[2]);
  return measure(argc > 1 ? std::atoi(argv[1]) : 200, argc > 2 ? std::atoi(argv[2]) : 1000);
} catch (const std::exception& error) {
  fmt::print(stderr, "bench_directing: {}\n", error.what());
  return 1;
}
