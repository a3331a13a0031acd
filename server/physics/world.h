#pragma once
// The physical world: bodies, joints and contacts on Bullet, stepped one substep at a time.
// No Bullet type leaves this module.

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "scene/scene.h"
#include "world/state.h"

namespace ziggurat::physics {

/// A joint with a coordinate, as the world counts them.
struct JointIndex {
  std::size_t value = 0;
};

class World {
 public:
  /// @param substep  length of a substep as the clock says [s]; if the scene allows less
  ///                 (max_substep) each is split inside
  World(const scene::Physics& physics, double substep);
  ~World();

  /// Adds an entity at its pose, now or while the world runs; its links take the next places of
  /// State::links.
  void add(const scene::Entity& entity);

  /// Takes an entity out: its bodies, joints and magnets are gone, and what rested on it falls. Its
  /// number and its places in State::links stay its own, and read() leaves them as they are.
  /// Nothing else may be asked of it afterwards but its joints, which are at 0.
  void remove(std::size_t entity);

  /// The first entity, in order of adding, that another would overlap at its pose as all stand now.
  /// The floor never counts; touching is not overlapping.
  std::optional<std::size_t> overlapped_by(const scene::Entity& entity) const;

  /// A revolute or prismatic joint of an entity added before.
  /// @param entity  in order of adding;  @param joint  index into Entity::joints
  JointIndex joint(std::size_t entity, std::size_t joint) const;

  /// Gives a joint a motor. Targets start at 0.
  /// @param max_impulse  what it may give per substep [N s] or [N m s]
  void add_motor(JointIndex joint, scene::JointMode mode, double max_impulse);
  /// @param target  [m] or [rad] in position mode, [m/s] or [rad/s] in velocity mode
  void set_target(JointIndex joint, double target);

  double position(JointIndex joint) const;  ///< [m] or [rad]; 0 as assembled
  double velocity(JointIndex joint) const;  ///< [m/s] or [rad/s]

  /// What a robot on wheels is to do over the ground. 0 and 0 at the start.
  /// @param entity  one with a traction, in order of adding
  /// @param velocity  along its x axis [m/s];  @param angular_velocity  about z [rad/s]
  void set_velocity(std::size_t entity, double velocity, double angular_velocity);
  /// @param speed  by which its turret turns more than the robot is to turn [rad/s]; none: the
  ///               turret turns with the robot, as at the start
  void set_turret(std::size_t entity, std::optional<double> speed);
  double turret(std::size_t entity) const;  ///< of the turret in the robot, [-pi, pi] [rad]

  /// Sets the currents of all magnets: current times its active field is added to a magnet's
  /// passive one. 0 at the start; without effect where the scene has no magnetism.
  /// @param currents  of the magnets of all entities, in order of adding
  void set_currents(std::span<const double> currents);

  /// Puts an entity to rest at a pose of its origin, joints as assembled.
  void move(std::size_t entity, const math::Pose& pose);

  /// Advances by one substep.
  void step();

  /// Writes origins and links; tick and time are the caller's.
  void read(world::State& state) const;
  /// The same of one entity that is present.
  void read(std::size_t entity, world::State& state) const;

  /// How stiff the scene's magnetic bonds are for its substeps: the largest product of substep and
  /// rate, and the entity it belongs to; 0 where there is no magnetism.
  struct Stiffness {
    std::size_t entity = 0;
    double product = 0;  ///< explicit steps are safe up to `safe` and unstable from 2 on
    double substep = 0;  ///< internal [s]
    double safe = 0;
  };
  Stiffness stiffest_bond() const;

  /// Kinetic plus gravitational energy of everything that moves [J].
  double energy() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace ziggurat::physics
