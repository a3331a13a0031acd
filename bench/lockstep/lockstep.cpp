// SPDX-License-Identifier: MIT
// Time of a lock-step tick compared with bare ZeroMQ with the same message sizes and processes.
//
// usage: bench_lockstep [PAIRS [TRANSPORT]]     9 pairs over ipc by default
//        bench_lockstep [PAIRS [TRANSPORT [PROCESSES ROBOTS]]]     one row
//        bench_lockstep [PAIRS] curve           our server with CURVE compared with it without,
//        over tcp
//
// In each pair both run alternately, burst by burst; this is repeated with new processes several
// times, because single figures depend on where the scheduler places the processes. Rely on the
// median ratio of all pairs, which the table contains.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "lockstep/arena.h"
#include "network/keys.h"

namespace ziggurat::bench {
namespace {

struct Row {
  std::size_t processes;
  std::size_t robots;
  double goal;  // ratio to bare ZeroMQ
};

constexpr Row rows[] = {{1, 1, 1.25},  {4, 1, 1.25},  {16, 1, 1.25},
                        {1, 16, 1.25}, {1, 256, 1.9}, {1, 1024, 2.2}};

constexpr int restarts = 5;  // of all processes per pair, to average over their placement
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
  double bare = 0;       // median tick of the reference, mean over all restarts [µs]
  double ours = 0;       // the same of our server [µs]
  double ours_late = 0;  // 99th percentile of our server, mean over all restarts [µs]
};

/// Runs both alternately, burst by burst.
template <class Arena>
void alternate(Arena& bare, Ours& ours, Pair& pair) {
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

Pair run_pair(const Setup& setup) {
  Pair pair;
  for (int restart = 0; restart < restarts; ++restart) {
    Ours ours(setup);
    if (setup.keys) {
      Setup plain = setup;
      plain.keys.reset();
      Ours bare(plain);
      alternate(bare, ours, pair);
    } else {
      Bare bare(setup, ours.bytes());
      alternate(bare, ours, pair);
    }
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
  std::printf("| %zu | %zu | %.0f | %.0f | %.0f | %.0f | **%.2f** | %.2f … %.2f |", row.processes,
              row.robots, quantile(bare, 0.5), quantile(ours, 0.5), quantile(late, 0.5),
              1e6 / quantile(ours, 0.5), ratio, *std::min_element(ratios.begin(), ratios.end()),
              *std::max_element(ratios.begin(), ratios.end()));
  if (!setup.keys) std::printf(" %.2f | %s |", row.goal, ratio <= row.goal ? "yes" : "no");
  std::puts("");
  std::fflush(stdout);
}

/// A temporary folder with key files; the destructor removes it.
class Keyring {
 public:
  Keyring() {
    if (::mkdtemp(folder_.data()) == nullptr) throw std::runtime_error("no folder for keys");
    keys_.server_public = network::write_key_pair(folder_ + "/server");
    keys_.server_secret = network::read_secret_key(folder_ + "/server.secret");
    keys_.client_public = network::write_key_pair(folder_ + "/client");
    keys_.client_secret = folder_ + "/client.secret";
  }
  ~Keyring() { std::filesystem::remove_all(folder_); }
  Keyring(const Keyring&) = delete;
  Keyring& operator=(const Keyring&) = delete;

  const Keys& keys() const { return keys_; }

 private:
  std::string folder_ = (std::filesystem::temp_directory_path() / "bench-keys-XXXXXX").string();
  Keys keys_;
};

void print_heading(const Setup& setup, int pairs) {
  std::printf("Lock-step ticks over %s%s, no physics, 4 joints per robot each way; %d pairs.\n\n",
              setup.transport.c_str(), setup.keys ? ", CURVE beside plain" : "", pairs);
  if (setup.keys) {
    std::puts(
        "| Processes | Robots each | Plain [µs] | CURVE [µs] | CURVE p99 [µs] | Ticks/s | "
        "Ratio | Range |");
    std::puts("|---|---|---|---|---|---|---|---|");
    return;
  }
  std::puts(
      "| Processes | Robots each | Bare [µs] | Ours [µs] | Ours p99 [µs] | Ticks/s | Ratio | "
      "Range | Goal | Met |");
  std::puts("|---|---|---|---|---|---|---|---|---|---|");
}

}  // namespace
}  // namespace ziggurat::bench

int main(int argc, char** argv) try {
  using namespace ziggurat::bench;
  const int pairs = argc > 1 ? std::max(1, std::atoi(argv[1])) : 9;
  Setup setup;
  std::optional<Keyring> keyring;
  if (argc > 2) setup.transport = argv[2];
  if (setup.transport == "curve") {
    setup.transport = "tcp";
    setup.keys = keyring.emplace().keys();
  }
  setup.client =
      std::filesystem::read_symlink("/proc/self/exe").parent_path() / "bench_lockstep_client";
  print_heading(setup, pairs);
  const bool is_one = argc > 4;
  for (const Row& row : rows) {
    const bool is_wanted =
        !is_one || (row.processes == std::stoul(argv[3]) && row.robots == std::stoul(argv[4]));
    if (is_wanted) run_row(row, setup, pairs);
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "bench_lockstep: %s\n", error.what());
  return 1;
}
