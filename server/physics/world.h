// SPDX-License-Identifier: MIT
#pragma once
// The physical world, one substep at a time: bodies, the core that moves them, and the plug-ins
// that push them. No Bullet type leaves this module.

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "physics/bodies/values.h"
#include "physics/stepping/team.h"
#include "scene/scene.h"
#include "timing/stopwatch.h"
#include "world/commands.h"
#include "world/state.h"

namespace ziggurat::math {
class Archive;
}

namespace ziggurat::physics {

class World {
 public:
  /// @param substep  length of a substep as the clock says [s]; if the scene allows less
  ///                 (max_substep) each is split inside
  World(const scene::Physics& physics, double substep);
  ~World();

  /// Adds an entity at its pose, now or while the world runs; its links take the next places of
  /// State::links.
  /// @throws std::bad_alloc; then nothing changes
  void add(const scene::Entity& entity);

  /// Undoes the last add(), if no step has followed.
  void take_back();

  /// Takes an entity out: its bodies, joints and magnets are gone, and what rested on it falls. Its
  /// number and its places in State::links are not used again, and read() leaves them as they are.
  /// Afterwards only its joints may be read, which are at 0.
  void remove(std::size_t entity);

  /// The first entity, in order of adding, that another would overlap at a pose of its origin,
  /// joints as assembled, at the current poses. The floor never counts; touching is not
  /// overlapping.
  /// @param except  in order of adding: does not count
  std::optional<std::size_t> overlapped_by(const scene::Entity& entity, const math::Pose& pose,
                                           std::optional<std::size_t> except = {}) const;

  /// A revolute or prismatic joint of an entity added before.
  /// @param entity  in order of adding;  @param joint  index into Entity::joints
  JointIndex joint(std::size_t entity, std::size_t joint) const;

  /// Gives a joint a motor. Targets start at 0.
  /// @param max_impulse  limit per substep [N s] or [N m s]
  void add_motor(JointIndex joint, scene::JointMode mode, double max_impulse);
  /// @param target  [m] or [rad] in position mode, [m/s] or [rad/s] in velocity mode
  void set_target(JointIndex joint, double target);

  double position(JointIndex joint) const;  ///< [m] or [rad]; 0 as assembled
  double velocity(JointIndex joint) const;  ///< [m/s] or [rad/s]

  /// The motion over the ground that a robot on wheels aims at. 0 and 0 at the start.
  /// @param entity  one with a traction, in order of adding
  /// @param velocity  along its x axis [m/s];  @param angular_velocity  about z [rad/s]
  void set_velocity(std::size_t entity, double velocity, double angular_velocity);
  /// @param speed  of its turret, in addition to the wanted turn rate of the robot [rad/s]; none:
  ///               the turret turns with the robot, as at the start
  void set_turret(std::size_t entity, std::optional<double> speed);
  double turret(std::size_t entity) const;  ///< of the turret in the robot, [-pi, pi] [rad]

  /// Lets a gripper of a robot on wheels hold what it touches, if that may be gripped: a point of
  /// it, about which it may turn. A turret that follows its robot then turns with what is held.
  /// Without effect while it holds something, after its grip tore, and of a robot that is fixed.
  /// @param entity  one with a traction, in order of adding
  void grip(std::size_t entity, const Gripper& gripper);
  void release(std::size_t entity);      ///< opens the gripper
  bool holds(std::size_t entity) const;  ///< false once a grip tore, or what it held was removed

  /// The target of an entity that flies, to be changed. At the start it hovers where it is.
  /// @param entity  one with a flight, in order of adding
  FlightTarget& flight_target(std::size_t entity);

  /// Sets the currents of all magnets: current times its active field is added to a magnet's
  /// passive one. 0 at the start; without effect where the scene has no magnetism.
  /// @param currents  of the magnets of all entities, in order of adding
  void set_currents(std::span<const double> currents);

  /// Puts forces and torques on links in the substeps from the next one on, instead of those of the
  /// call before.
  friend void set_pushes(World& world, std::span<const world::Push> pushes);

  /// Puts a joint of an entity that is present to a position [m] or [rad] and a speed [m/s] or
  /// [rad/s]. What hangs on it follows; its other joints and its root stay as they are.
  /// @param joint  of joint()
  friend void set_joint(World& world, std::size_t entity, JointIndex joint, double position,
                        double velocity);

  /// Begins to watch what touches a link of an entity added before.
  /// @param link  index into Entity::links
  void watch_contacts(std::size_t entity, std::size_t link);
  /// Returns a watched link's contacts since the last call, or since it is watched; nothing if its
  /// entity was removed.
  LinkTouch take_touch(std::size_t entity, std::size_t link);

  /// Lists all contacts of the last substep, in ascending order of their links.
  /// @param to  its content is replaced
  void list_contacts(std::vector<world::Contact>& to) const;

  /// Puts an entity to rest at a pose of its origin, joints as assembled.
  void move(std::size_t entity, const math::Pose& pose);

  /// Advances by one substep.
  /// @param watch  gets the times of its stages; null: none
  void step(timing::Stopwatch* watch = nullptr);
  /// Substeps are shared by so many threads, with the same bits for any number. 1 at first.
  /// @throws std::system_error if the system allows no more threads; then nothing changes
  void set_threads(unsigned threads);
  /// The team of set_threads(), for other work between substeps; null: one thread.
  dynamics::Team* team() const;

  /// Writes origins and links; tick and time are the caller's.
  void read(world::State& state) const;
  /// The same of one entity that is present.
  void read(std::size_t entity, world::State& state) const;
  /// The same as read(), of a state that was read before and has not been changed since: what has
  /// slept since then is left out.
  void read_moved(world::State& state) const;

  /// Stiffness of the scene's magnetic bonds: the product of substep and rate that is the largest
  /// share of a safe one, and its entity; 0 without magnetism.
  struct Stiffness {
    std::size_t entity = 0;
    double product = 0;
    double substep = 0;  ///< internal [s]
    double safe = 1;     ///< bonds gain no energy while `product` is below this
  };
  Stiffness stiffest_bond() const;

  Convergence convergence() const;

  /// All that the next substep reads, between two substeps. What is read must come from a world in
  /// which the same was added and removed in the same order.
  /// @throws math::ArchiveError; then the state is undefined
  friend void archive_fields(math::Archive& archive, World& world);

  /// Kinetic plus gravitational energy of everything that moves [J].
  double energy() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace ziggurat::physics
