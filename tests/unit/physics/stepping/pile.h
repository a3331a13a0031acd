// SPDX-License-Identifier: MIT
#pragma once
// Cubes of 1 cm dropped in layers, turned at random, into a bin.

#include <random>

#include "touching.h"

namespace ziggurat::dynamics::testing {

inline Touching pile(int count) {
  Touching world;
  const double side = 0.01;
  const int across = std::max(3, static_cast<int>(std::lround(std::cbrt(count / 2.0))));
  const double wall = across * 0.0075 + 0.002;
  world.planes.push_back({Vector3::Zero(), Vector3::UnitZ()});
  for (int k = 0; k < 4; ++k) {
    const Vector3 normal(k == 0 ? 1 : k == 1 ? -1 : 0, k == 2 ? 1 : k == 3 ? -1 : 0, 0);
    world.planes.push_back({normal * -wall, normal});
  }
  std::mt19937 random(1);
  const auto draw = [&] { return random() / 2147483647.5 - 1; };
  for (int i = 0; i < count; ++i) {
    const int layer = i / (across * across), x = i % across, y = i / across % across;
    double drawn[6];
    for (double& value : drawn) value = draw();
    const Vector3 place(0.015 * (x - (across - 1) / 2.0) + 0.001 * drawn[0],
                        0.015 * (y - (across - 1) / 2.0) + 0.001 * drawn[1], 0.015 * (layer + 1));
    const Quaternion turn(drawn[2], drawn[3], drawn[4], drawn[5]);
    world.add_box(Vector3::Constant(side), 1e-3, {place, turn.normalized()}, 0.7);
  }
  return world;
}

}  // namespace ziggurat::dynamics::testing
