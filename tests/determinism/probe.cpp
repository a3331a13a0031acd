// SPDX-License-Identifier: MIT
// Runs scenes one after the other in one process, without network, and prints the hash of every
// tick. All actuators follow a fixed rule: results depend on the program and the scene only.
//
// usage: determinism_probe TICKS SCENE...

#include <cstdlib>
#include <exception>
#include <iostream>

#include "math/hash.h"
#include "scene/reader.h"
#include "simulation/simulation.h"

namespace {

void run(const std::string& path, int ticks) {
  auto read = ziggurat::scene::read_file(path);
  if (!read.ok()) throw ziggurat::scene::SceneError(read.problems);
  ziggurat::simulation::Simulation simulation(read.scene, {7});
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
  for (int i = 2; i < count; ++i) run(arguments[i], std::atoi(arguments[1]));
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
