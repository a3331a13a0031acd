// SPDX-License-Identifier: MIT
#pragma once
// A world at one moment, to go back to. docs/recordings.md, section Snapshots.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"

namespace ziggurat::world {
struct Layout;
}

namespace ziggurat::simulation {

/// Entities that may be spawned in a world, since its start or a reset.
inline constexpr std::size_t most_spawned = 10'000;
inline constexpr std::size_t longest_spawned = std::size_t{1} << 20;  ///< the text of one [bytes]

/// Why a snapshot can't have this name, without a full stop; none if it can.
std::optional<std::string> fault_of_snapshot_name(std::string_view name);

/// Entity that came or went between two ticks.
struct WorldEdit {
  enum class Kind : std::uint8_t { spawn, remove };
  Kind kind = Kind::spawn;
  std::uint64_t tick = 0;  ///< of the state that it was done to
  std::size_t entity = 0;  ///< into Layout::entities
  std::shared_ptr<const scene::Entity> spawned = {};
  std::string xml = {};  ///< of a spawn, if it is known
};

/// Changes after which a new world has the entities of this one.
struct History {
  std::vector<WorldEdit> edits;  ///< in order
};

/// Counts the first robots of a world that are still the same ones after it is restored: those of
/// the scene, and those spawned before the histories part.
/// @param layout  of the world now
std::size_t common_robots(const History& now, const History& then, const world::Layout& layout);

struct SnapshotError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A value: it stays what it is whatever becomes of the world.
struct Snapshot {
  std::uint64_t seed = 1;
  std::uint64_t tick = 0;
  std::uint64_t hash = 0;  ///< as Simulation::hash()
  History history;
  std::vector<std::byte> state;
  bool is_checked = false;  ///< made by snapshot(), not read from bytes

  std::size_t size() const;  ///< about what it takes [bytes]
};

/// Origin of a snapshot's file. Empty fields are not compared when it is read.
struct Origin {
  std::string scene_hash;
  std::string build;
};

/// @throws SnapshotError if something was spawned whose element is not known
std::vector<std::byte> to_bytes(const Snapshot& snapshot, const Origin& origin);

/// @param origin  must be that of the bytes, where it is not empty
/// @param read    reads the element of an entity that was spawned; may throw scene::SceneError
/// @throws SnapshotError if the bytes are no snapshot, damaged, or from elsewhere
Snapshot from_bytes(std::span<const std::byte> bytes, const Origin& origin,
                    const std::function<scene::Entity(const std::string& xml)>& read);

}  // namespace ziggurat::simulation
