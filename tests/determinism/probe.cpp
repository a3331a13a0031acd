// SPDX-License-Identifier: MIT
// Runs scenes one after the other in one process, without network, and prints the hash of every
// tick. All actuators follow a fixed rule: results depend on the program and the scene only.
//
// usage: determinism_probe [--threads N] TICKS SCENE...

#include <cstdlib>
#include <exception>
#include <iostream>
#include <string_view>

#include "math/hash.h"
#include "scene/reader.h"
#include "simulation/simulation.h"

namespace {

void run(const std::string& path, int ticks, unsigned threads) {
  auto read = ziggurat::scene::read_file(path);
  if (!read.ok()) throw ziggurat::scene::SceneError(read.problems);
  ziggurat::simulation::Simulation simulation(read.scene, {7});
  simulation.set_threads(threads);
  std::cout << "scene " << path << '\n';
  for (int tick = 0; tick <= ticks; ++tick) {
    if (tick > 0) simulation.step();
    std::cout << "hash " << tick << ' ' << ziggurat::math::to_hex(simulation.hash()) << '\n';
    auto& targets = simulation.commands().joint_targets;
    for (std::size_t i = 0; i < targets.size(); ++i) {
      targets[i] = (static_cast<double>(i % 3) + 1) * (tick / 10 % 2 == 0 ? 1 : -1);
    }
  }
}

}  // namespace

int main(int count, char** arguments) try {
  const bool has_threads = count > 2 && std::string_view(arguments[1]) == "--threads";
  const unsigned threads = has_threads ? static_cast<unsigned>(std::atoi(arguments[2])) : 1;
  const int ticks = has_threads ? 3 : 1;
  for (int i = ticks + 1; i < count; ++i) run(arguments[i], std::atoi(arguments[ticks]), threads);
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
