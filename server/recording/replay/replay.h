// SPDX-License-Identifier: MIT
#pragma once
// Repeats a run from its inputs: what was done to the world and what its robots wanted, tick by
// tick. It knows no file; anything that yields the inputs in their order will do.
//
//   Replay replay(world, open, source);
//   while (replay.advance()) {  // the world is in the next recorded state
//     … replay.is_same() …
//     replay.act();             // what happened before the next step; optional
//   }

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "scene/additions.h"
#include "scene/files.h"
#include "scene/scene.h"
#include "simulation/simulation.h"
#include "simulation/snapshot.h"
#include "timing/stopwatch.h"
#include "world/commands.h"
#include "world/state.h"

namespace google::protobuf {
template <typename Element>
class RepeatedPtrField;
}

namespace ziggurat::v1 {
class Act;
class Act_Move;
class Act_Restore;
class Inputs;
}  // namespace ziggurat::v1

namespace ziggurat::replay {

/// A world at tick 0, of the recording's scene and seed.
struct World {
  const scene::Scene& scene;
  const scene::Additions& additions;
  simulation::Simulation& simulation;
  std::uint64_t& seed;  ///< changes with resets
};

class Replay {
 public:
  /// The next inputs, which stay until the next call; null after the last.
  /// @throws RecordingError
  using Source = std::function<const v1::Inputs*()>;

  /// @param world  must outlive this
  /// @param open   opens the files that spawned elements name
  Replay(World world, scene::OpenFile open, Source source);

  /// Takes the world to the next recorded state: at the first call to the first one. False: there
  /// is none; then the world stays.
  /// @throws RecordingError for inputs that this world cannot have had; std::runtime_error of a
  /// step
  /// @param watch  gets the times of the step's stages; null: none
  bool advance(timing::Stopwatch* watch = nullptr);
  /// Does what happened after the present state: acts, then commands. advance() does it otherwise.
  /// @throws RecordingError
  void act();

  /// Source of embedded snapshots: by the name of their file.
  using OpenSnapshot = std::function<simulation::Snapshot(const std::string& file)>;
  void open_snapshots_by(OpenSnapshot open) { open_snapshot_ = std::move(open); }

  /// The poses and velocities of the present inputs' state; null: they were not recorded.
  using Links = std::function<const std::vector<world::LinkState>*()>;
  /// Nothing is simulated: the recorded states are shown one after the other. What robots sense
  /// stays as at the begin, and no hash is computed. @pre nothing was repeated yet
  void show(Links links) { links_ = std::move(links); }
  /// Puts the world where the recording begins. @throws RecordingError if it does not fit
  void begin_at(const simulation::Snapshot& snapshot) { restore_to(snapshot); }

  /// Told of each act, after it was done.
  void tell(std::function<void(const v1::Act&)> told) { told_ = std::move(told); }

  /// Inputs of the current state.
  const v1::Inputs& inputs() const { return *inputs_; }
  /// As computed, behind act() with what it has changed; if it is shown, as recorded.
  std::uint64_t hash() const { return hash_; }
  bool is_same() const;  ///< the recorded hash is the same
  /// Number of resets and restores, moves, spawns and removals.
  std::uint64_t changes() const { return changes_; }
  /// Number of first robots that were still the same ones after the last restore.
  std::size_t common_robots() const { return common_robots_; }

 private:
  void show_state();
  using Acts = google::protobuf::RepeatedPtrField<v1::Act>;
  void repeat(const Acts& acts);
  void apply(const v1::Act& act);
  void move(const v1::Act_Move& move);
  void remove(const std::string& id);
  void spawn(const std::string& xml);
  void reset(std::uint64_t seed);
  void snapshot(const std::string& name);
  void restore(const v1::Act_Restore& restore);
  void restore_to(const simulation::Snapshot& snapshot);
  std::optional<std::size_t> find(const std::string& id);
  std::size_t entity_named(const std::string& id);
  [[noreturn]] void fail(const std::string& what) const;

  World world_;
  scene::OpenFile open_;
  Source source_;
  std::function<void(const v1::Act&)> told_;
  const v1::Inputs* inputs_ = nullptr;
  world::Commands commands_;                               // of all inputs so far
  std::map<std::string, simulation::Snapshot> snapshots_;  // by name
  std::size_t snapshots_size_ = 0;                         // of all of them [bytes]
  OpenSnapshot open_snapshot_;
  Links links_;  // empty: it is simulated
  std::uint64_t hash_ = 0, changes_ = 0;
  std::size_t common_robots_ = 0;
  std::size_t spawned_bytes_ = 0;                               // of what is spawned in this world
  std::unordered_map<std::string, std::size_t> spawned_sizes_;  // by element
  std::uint64_t epoch_ = 0, tick_ = 0;                          // of the present state
  bool has_commands_ = false, acted_ = false;
  struct Names {
    std::unordered_map<std::string, std::size_t> last;  ///< by id: the last entity that has it
    std::size_t entities = 0;                           ///< that are in it
  };
  Names names_;  // of this world
};

}  // namespace ziggurat::replay
