// SPDX-License-Identifier: MIT
#include "simulation/show.h"

#include <fmt/format.h>

#include <cmath>

#include "simulation/parts.h"

namespace ziggurat::simulation {

void show(Simulation& to, std::uint64_t tick, std::span<const world::LinkState> links) {
  Parts& p = to.parts();
  world::State& state = p.state;
  if (links.size() != state.links.size()) {
    throw SnapshotError(fmt::format("there are poses of {} links, and the world has {}",
                                    links.size(), state.links.size()));
  }
  p.physics.read(state);  // as built: where each origin is in its reference link
  for (std::size_t i = 0; i < state.origins.size(); ++i) {
    if (state.is_absent(i)) continue;
    const std::size_t reference = p.layout.entities[i].links.begin + p.entities[i].reference_link;
    const math::Pose in_link = math::inverse(state.links[reference].pose) * state.origins[i];
    state.origins[i] = links[reference].pose * in_link;
  }
  state.links.assign(links.begin(), links.end());
  state.tick = tick;
  state.time_ns = std::llround(static_cast<long double>(tick) * 1e9L / p.ticks_per_second);
  state.led_colors = p.commands.led_colors;
  state.directional_led_colors = p.commands.directional_led_colors;
  state.tag_payloads = p.commands.tag_payloads;
  state.rays.clear();
  state.frusta.clear();
  if (const auto entity = first_not_finite(p.layout, state)) {
    throw SnapshotError(
        fmt::format("the pose or velocity of '{}' is not finite", p.layout.entities[*entity].id));
  }
}

void repeat(Simulation& to, const scene::Scene& scene, const WorldEdit& edit) {
  to.parts().repeat_edit(scene, edit);
  to.parts().history.edits.push_back(edit);
}

}  // namespace ziggurat::simulation
