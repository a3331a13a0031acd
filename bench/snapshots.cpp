// SPDX-License-Identifier: MIT
// Cost of a snapshot and of a restore. Thread CPU time, medians of 21.
//
// usage: bench_snapshots TICK SCENE...

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "scene/reader.h"
#include "simulation/simulation.h"

namespace {

using namespace ziggurat;

double now() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// [ms]
template <class Function>
double median_of(int runs, Function function) {
  std::vector<double> times;
  for (int i = 0; i < runs; ++i) {
    const double begin = now();
    function();
    times.push_back(1e3 * (now() - begin));
  }
  std::ranges::sort(times);
  return times[times.size() / 2];
}

void measure(const std::string& path, int tick) {
  const auto read = scene::read_file(path);
  if (!read.ok()) throw scene::SceneError(read.problems);
  simulation::Simulation simulation(read.scene, {7, {}});
  const auto drive = [&] {
    auto& targets = simulation.commands().joint_targets;
    for (std::size_t i = 0; i < targets.size(); ++i) targets[i] = i % 2 == 0 ? 1 : -1;
  };
  drive();
  for (int i = 0; i < tick; ++i) simulation.step();
  const simulation::Snapshot snapshot = simulation.snapshot();
  simulation::Snapshot elsewhere = snapshot;
  elsewhere.is_checked = false;
  constexpr int runs = 21;
  const double keep = median_of(runs, [&] { (void)simulation.snapshot(); });
  const double restore = median_of(runs, [&] { simulation.restore(read.scene, snapshot); });
  const double rebuild = median_of(3, [&] { simulation.restore(read.scene, elsewhere); });
  const double step = median_of(runs, [&] { simulation.step(); });
  fmt::print(
      "{}, tick {}: snapshot {:.3f} ms, restore {:.3f} ms, in a new world {:.1f} ms, "
      "{} bytes; a tick {:.3f} ms\n",
      path, tick, keep, restore, rebuild, snapshot.size(), step);
}

}  // namespace

int main(int count, char** arguments) try {
  if (count < 3) {
    std::puts("usage: bench_snapshots TICK SCENE...");
    return 1;
  }
  for (int i = 2; i < count; ++i) measure(arguments[i], std::atoi(arguments[1]));
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
