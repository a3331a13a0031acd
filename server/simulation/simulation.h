// SPDX-License-Identifier: MIT
#pragma once
// The tick: apply commands -> physics substeps -> state -> observations. No sockets here;
// replay, benchmarks and tests drive the same object.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "physics/bodies/values.h"
#include "scene/scene.h"
#include "simulation/placement.h"
#include "simulation/snapshot.h"
#include "timing/stopwatch.h"
#include "world/commands.h"
#include "world/layout.h"
#include "world/state.h"

namespace ziggurat::simulation {

struct Parts;

struct Options {
  std::uint64_t seed = 1;  ///< of every random stream; not 0
  TellStep tell = {};      ///< may be empty
};

class Simulation {
 public:
  /// Places everything, distributing what the scene distributes.
  /// @throws scene::SceneError if something can't be placed or built
  Simulation(const scene::Scene& scene, const Options& options);
  ~Simulation();

  const world::Layout& layout() const;
  /// As they were placed or spawned, for each of Layout::entities.
  const std::vector<scene::Entity>& entities() const;
  const world::State& state() const;                ///< of the last tick; tick 0 = as placed
  const world::Observations& observations() const;  ///< of the last tick
  world::Commands& commands();  ///< applied at the start of the next tick; values persist

  /// Destroys the world and builds it again as a new simulation of the same scene: removed entities
  /// are back, spawned ones are no longer in the layout. The layout stays where it is; states,
  /// observations and commands move.
  /// @throws as the constructor, if something can't be placed with this seed; then nothing changes
  void reset(const scene::Scene& scene, const Options& options);

  /// Substeps are shared by so many threads, with the same bits for any number. 1 at first; stays
  /// after a reset and a restore.
  /// @throws std::system_error if the system allows no more threads; then nothing changes
  void set_threads(unsigned threads);

  /// Puts an entity to rest at a pose of its origin, joints as assembled. What robots sense of it
  /// they sense at the next tick.
  /// @param entity  into Layout::entities
  void move(std::size_t entity, const math::Pose& pose);

  /// Adds an entity behind all others; nothing of what the others are, sense or do changes before
  /// the next tick. The observations of a new robot are those of tick 0.
  /// @param scene  the one that this was made from
  /// @param entity  its id must differ from those of all entities that are present
  /// @param xml    the element, for snapshots that are written to files; may be empty
  /// @throws scene::SceneError if it overlaps another entity, std::bad_alloc; then nothing changes
  void spawn(const scene::Scene& scene, const scene::Entity& entity, std::string xml = {});

  /// Takes an entity out. Its places stay in all arrays, as they are; so does its name.
  /// @param entity  into Layout::entities, one that is present
  void remove(std::size_t entity);

  /// Whether contacts() lists contacts; that costs time. Not at first, and not after a reset; after
  /// a restore as before it. No result depends on it.
  void list_contacts(bool wanted);
  /// Contacts of the last substep; empty unless they are listed.
  const std::vector<world::Contact>& contacts() const;

  /// Whether rays() lists the rays of all devices from the next tick on, whether they have
  /// `show_rays` or not; that costs time. Not at first, and not after a reset. No result depends on
  /// it.
  void list_rays(bool wanted);
  /// Rays of the last tick; empty unless they are listed.
  const std::vector<world::Ray>& rays() const;

  /// Advances by one tick.
  /// @param watch  gets the times of its stages, on which no result depends; null: none
  /// @throws std::runtime_error that names the first entity whose state is not finite then
  void step(timing::Stopwatch* watch = nullptr);

  /// Hash of the last tick's state and observations.
  std::uint64_t hash() const;

  /// The world as it is, commands included.
  Snapshot snapshot() const;
  /// Puts the world back: what follows is what followed the snapshot, bit for bit, with the same
  /// commands. Entities that came since are gone, those that went are back.
  /// @param scene  the one that both were made from
  /// @param seed   given: the snapshot is of a scene that may have other values, but the same
  /// entities and
  ///               devices; this is the seed from then on, not 0. With another one than the
  ///               snapshot's all that is random is drawn anew
  /// @throws SnapshotError if it does not fit; then nothing changes
  void restore(const scene::Scene& scene, const Snapshot& snapshot,
               std::optional<std::uint64_t> seed = {});
  /// History of the world since the start, as far as snapshots need it.
  const History& history() const;
  /// The first field in which the state differs from that of a snapshot: empty if none
  /// does.
  std::string first_difference(const Snapshot& snapshot) const;

  /// Notices to the scene's author before the run: sentences, usually none.
  std::vector<std::string> notices() const;

  /// Convergence of the physics since the start or the last reset.
  physics::Convergence convergence() const;

  double tick_length() const;      ///< simulated time per tick by the clock on the wall [s]
  double physical_length() const;  ///< physical time per tick: shorter under beta50 [s]

  /// The state that free functions of this folder read and change (parts.h).
  Parts& parts() { return *parts_; }
  const Parts& parts() const { return *parts_; }

 private:
  std::unique_ptr<world::Layout> layout_;  // others keep references to it
  std::unique_ptr<Parts> parts_;
  unsigned threads_ = 1;  // see set_threads()
};

/// The first entity that another would overlap at a pose of its origin, joints as assembled;
/// nothing if the place is free. The floor does not count; touching is not overlapping, nor are 0.1
/// mm, as bodies at rest may be in each other.
/// @param except  into Layout::entities: does not count
std::optional<std::size_t> overlapped_by(const Simulation& in, const scene::Entity& entity,
                                         const math::Pose& pose,
                                         std::optional<std::size_t> except = {});

/// Notice to the scene's author about a slow run: a sentence if substeps were divided often.
std::optional<std::string> slow_notice(const Simulation& simulation);

}  // namespace ziggurat::simulation
