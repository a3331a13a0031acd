// What a lock-step tick costs beside bare ZeroMQ with the same bytes and processes.
//
// usage: bench_lockstep [PAIRS [TRANSPORT]]     9 pairs over ipc by default
//
// Each pair lets both take turns, burst by burst, and does so with fresh processes several times:
// single figures depend on where the scheduler puts whom. The table has the median ratio of all
// pairs, which is what to rely on.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <vector>

#include "lockstep/arena.h"

namespace ziggurat::bench {
namespace {

struct Row {
  std::size_t processes;
  std::size_t robots;
  double goal;  // ratio to bare ZeroMQ
};

constexpr Row rows[] = {{1, 1, 1.25},  {4, 1, 1.25},  {16, 1, 1.25},
                        {1, 16, 1.25}, {1, 256, 1.9}, {1, 1024, 2.2}};

constexpr int restarts = 5;  // of all processes, per pair: averages out where they are put
constexpr int warm_up = 50;  // ticks
constexpr int bursts = 3;
constexpr int burst = 150;  // ticks

double quantile(std::vector<double> values, double q) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(q * double(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Appends the time of each tick [µs].
template <class Arena>
void run_burst(Arena& arena, std::vector<double>& times) {
  for (int i = 0; i < burst; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    arena.tick();
    const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - begin;
    times.push_back(time.count());
  }
}

struct Pair {
  double bare = 0;       // median tick, mean of all restarts [µs]
  double ours = 0;       // the same of ours [µs]
  double ours_late = 0;  // 99th percentile, mean of all restarts [µs]
};

Pair run_pair(const Setup& setup) {
  Pair pair;
  for (int restart = 0; restart < restarts; ++restart) {
    Ours ours(setup);
    Bare bare(setup, ours.bytes());
    for (int i = 0; i < warm_up; ++i) ours.tick();
    for (int i = 0; i < warm_up; ++i) bare.tick();
    std::vector<double> ours_times;
    std::vector<double> bare_times;
    for (int i = 0; i < bursts; ++i) {
      run_burst(bare, bare_times);
      run_burst(ours, ours_times);
    }
    pair.bare += quantile(bare_times, 0.5) / restarts;
    pair.ours += quantile(ours_times, 0.5) / restarts;
    pair.ours_late += quantile(ours_times, 0.99) / restarts;
  }
  return pair;
}

void run_row(const Row& row, Setup setup, int pairs) {
  setup.processes = row.processes;
  setup.robots = row.robots;
  std::vector<double> bare, ours, late, ratios;
  for (int i = 0; i < pairs; ++i) {
    const Pair pair = run_pair(setup);
    bare.push_back(pair.bare);
    ours.push_back(pair.ours);
    late.push_back(pair.ours_late);
    ratios.push_back(pair.ours / pair.bare);
  }
  const double ratio = quantile(ratios, 0.5);
  std::printf(
      "| %zu | %zu | %.0f | %.0f | %.0f | %.0f | **%.2f** | %.2f … %.2f | %.2f | %s |\n",
      row.processes, row.robots, quantile(bare, 0.5), quantile(ours, 0.5), quantile(late, 0.5),
      1e6 / quantile(ours, 0.5), ratio, *std::min_element(ratios.begin(), ratios.end()),
      *std::max_element(ratios.begin(), ratios.end()), row.goal, ratio <= row.goal ? "yes" : "no");
  std::fflush(stdout);
}

}  // namespace
}  // namespace ziggurat::bench

int main(int argc, char** argv) try {
  using namespace ziggurat::bench;
  const int pairs = argc > 1 ? std::max(1, std::atoi(argv[1])) : 9;
  Setup setup;
  if (argc > 2) setup.transport = argv[2];
  setup.client =
      std::filesystem::read_symlink("/proc/self/exe").parent_path() / "bench_lockstep_client";
  std::printf("Lock-step ticks over %s, no physics, 4 joints per robot each way; %d pairs.\n\n",
              setup.transport.c_str(), pairs);
  std::puts(
      "| Processes | Robots each | Bare [µs] | Ours [µs] | Ours p99 [µs] | Ticks/s | Ratio | "
      "Range | Goal | Met |");
  std::puts("|---|---|---|---|---|---|---|---|---|---|");
  for (const Row& row : rows) run_row(row, setup, pairs);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "bench_lockstep: %s\n", error.what());
  return 1;
}
