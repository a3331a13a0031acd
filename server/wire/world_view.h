// SPDX-License-Identifier: MIT
#pragma once
// World view of a director: the true state of the entities that it subscribed to.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "wire/messages.h"
#include "wire/observation.h"
#include "world/layout.h"
#include "world/state.h"

namespace ziggurat::v1 {
class WorldLayout;
class WorldState;
}  // namespace ziggurat::v1

namespace ziggurat::wire {

/// The world at a tick. Seen, not owned.
struct Truth {
  const world::Layout& layout;
  const std::vector<scene::Entity>& entities;  ///< as placed, for each of Layout::entities
  const world::State& state;
  const world::Observations& observations;
  const std::vector<world::Contact>& contacts;
};

/// The entities that a session is told of, and where their parts stand in its arrays. It only
/// grows.
struct WorldView {
  Subscription subscription;
  std::vector<std::size_t> entities;  ///< into Layout::entities, in scene order
  std::vector<bool> removed;          ///< per entity of the view: it is known to be absent
  std::size_t considered = 0;         ///< so many of Layout::entities are in the view or not wanted
  std::size_t told = 0;               ///< entities of the view that the client knows
  bool is_new = true;                 ///< the client knows nothing of this world
  std::vector<std::int32_t> link_places;   ///< per link of the layout; not in the view: `elsewhere`
  std::vector<std::int32_t> radio_places;  ///< likewise
  std::vector<std::size_t> magnets, radios;  ///< into the layout's lists
  std::int32_t link_count = 0;

  static constexpr std::int32_t the_floor = -1, elsewhere = -2;
};

/// Puts an entity behind those of the view, or leaves it out. Once for each, in scene order.
void consider(WorldView& view, const Truth& truth, std::size_t entity, bool is_wanted);

/// Whether the client must be told of the view before the next state.
bool has_news(const WorldView& view, const world::State& state);
/// Tells what it does not know yet. `to` is clear.
/// @returns  false if that would be more than `limit` bytes; then `to` has only a part
bool fill(WorldView& view, const Truth& truth, const std::vector<scene::Controller>& controllers,
          std::size_t limit, v1::WorldLayout& to);

/// The parts of a state whose number or size is not that of devices alone.
ReadingSize size_of_readings(const WorldView& view, const Truth& truth);
/// The state in the order of the view; `to` is clear.
void fill(const WorldView& view, const Truth& truth, v1::WorldState& to);

}  // namespace ziggurat::wire
