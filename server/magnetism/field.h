// SPDX-License-Identifier: MIT
#pragma once
// All magnets of a world and what they do to the bodies that carry them.
//
// A rigid body may be any link; its frame here is any frame fixed to it, chosen by the caller (the
// centre-of-mass frame is the natural one): positions of magnets are given in it, poses are of it,
// and wrenches are about its origin. The order of the magnets is part of the result.

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "magnetism/adaptive.h"
#include "magnetism/dipole.h"
#include "magnetism/neighbours.h"
#include "magnetism/relaxation.h"
#include "magnetism/shape.h"

namespace ziggurat::magnetism {

using math::Pose;
using math::Quaternion;

struct Magnet {
  std::uint32_t body = 0;                           ///< index of the rigid body it moves with
  Vector3 position = Vector3::Zero();               ///< of its centre, in the body [m]
  Quaternion orientation = Quaternion::Identity();  ///< rotation from the shape's axes to the body
  Vector3 passive_moment = Vector3::Zero();         ///< in the body's axes [A m^2]
  Vector3 active_moment = Vector3::Zero();          ///< added per unit of current, likewise
  Shape shape = PointShape{};
  /// Radius of the ball about its centre that no other magnet's ball can enter [m]: where the balls
  /// of two overlap, their distance counts as the sum of the radii.
  double core = 0;
  /// Turns without friction in a socket of the body at `position`: its orientation is a state of
  /// the field. A magnet that turns freely counts as a sphere whatever its shape.
  bool freely_turning = false;
};

/// Two magnets; first < second.
using MagnetPair = std::pair<std::uint32_t, std::uint32_t>;

/// Some pairs of fixed magnets, whose forces are wanted more often than all others'.
class PairSet {
 public:
  /// @param pairs  in ascending order
  void assign(std::span<const MagnetPair> pairs);
  /// The magnets of the pairs, ascending.
  std::span<const std::uint32_t> magnets() const { return magnets_; }

 private:
  friend class Field;
  std::vector<std::uint32_t> first_, second_;  // padded while they are in use
  std::vector<std::uint32_t> magnets_;
};

enum class Precision {
  dipole,    ///< every magnet is one dipole
  adaptive,  ///< magnets with a shape are as many sources as the tolerance asks for
};

struct Options {
  /// Magnets whose centres are farther apart do not act on each other [m].
  double max_distance = std::numeric_limits<double>::infinity();
  Precision precision = Precision::dipole;
  double tolerance = 0.01;  ///< of force and torque of a pair, adaptive only; 1e-3 to 0.1
  /// Share of max_distance over which the interaction fades out smoothly; 0: it ends with a step.
  double taper = 0;
  double minimum_distance = 1e-6;  ///< separations below count as this [m]
  RelaxationOptions relaxation;
  const Kernel* kernel = nullptr;  ///< for tests; none: the best for this processor
};

class Field {
 public:
  /// @param magnets  their bodies < bodies
  Field(std::vector<Magnet> magnets, std::size_t bodies, const Options& options);

  /// Turns the freely turning magnets and finds the forces at the poses given.
  /// @param dt        length of the substep [s]; 0: nothing turns
  /// @param bodies    pose of each body in the world
  /// @param currents  of each magnet
  /// @param wrenches  out, per body: force, and torque about the body's origin, in the world
  void evaluate(double dt, std::span<const Pose> bodies, std::span<const double> currents,
                std::span<Wrench> wrenches);

  /// The forces of some pairs alone; nothing turns. Unlike evaluate() it looks at no others.
  /// @param bodies    poses; those of the pairs' magnets count
  /// @param wrenches  out; those of the pairs' bodies are set, others stay
  void evaluate(PairSet& pairs, std::span<const Pose> bodies, std::span<const double> currents,
                std::span<Wrench> wrenches);

  /// Back to the start: freely turning magnets as in the scene, up to the tilt.
  void reset();

  std::span<const Magnet> magnets() const { return magnets_; }
  bool turns_freely() const { return !free_.empty(); }  ///< one of them does

  /// Per magnet: its rotation in the body since the start; identity unless freely turning.
  std::span<const Quaternion> turns() const { return turns_; }
  /// Puts back what turns() gave, for a saved state.
  void set_turns(std::span<const Quaternion> turns);

  /// Pairs of different bodies whose magnets are not farther apart than this, and than
  /// max_distance, as of the last evaluate(); in ascending order.
  /// @param reach  [m]
  void list_near(double reach, std::vector<MagnetPair>& out);

  double core(std::size_t magnet) const { return positions_[magnet].w; }  ///< as it counts [m]

  /// As of the last evaluate(), in the world.
  Vector3 position(std::size_t magnet) const;  ///< [m]
  Vector3 moment(std::size_t magnet) const;    ///< [A m^2]

  /// Number of times that the neighbour list was built so far.
  std::size_t rebuilds() const { return neighbours_.rebuilds(); }

 private:
  void place(std::span<const Pose> bodies, std::span<const double> currents);
  void place(std::size_t magnet, const Pose& body, double current);
  void turn(double dt);
  template <class Visit>
  void visit_near_pairs(const Visit& visit);
  void add_field_of_shapes(std::size_t first, std::size_t second);
  void add_interaction_of_shapes(std::size_t first, std::size_t second);
  double fade(double distance) const;
  bool is_near(std::size_t first, std::size_t second) const;
  void collect(std::span<const Pose> bodies, std::span<Wrench> wrenches) const;
  void collect(std::size_t magnet, const Pose& body, Wrench& wrench) const;
  Dipoles dipoles() const { return {positions_.data(), moments_.data(), magnets_.size()}; }

  const Kernel& kernel_;
  Options options_;
  std::vector<Magnet> magnets_;
  std::size_t bodies_;
  Range range_;
  Neighbours neighbours_;
  std::size_t partners_built_ = 0;  // rebuilds() when partners_ was made
  Partners partners_;
  std::vector<std::uint32_t> free_;  // freely turning magnets, ascending
  std::vector<Quaternion> turns_;
  std::vector<Eigen::Matrix3d> rotations_;  // of the bodies, as of the last evaluate()

  // One row per magnet and padding, see kernel.h.
  std::vector<Row> positions_, moments_, forces_, fields_;
  std::vector<Row> external_;  // fields on freely turning magnets beyond those of dipoles

  // Adaptive precision: what shapes do beyond dipoles.
  std::optional<ShapedMagnets> shapes_;
  std::optional<Neighbours> near_;  // where neighbours_ keeps no list

  // Neighbour list of list_near() where near_ keeps none.
  double close_reach_ = 0;
  std::optional<Neighbours> close_;
  std::vector<Row> torques_;
  std::vector<std::uint32_t> body_of_;  // of every magnet
};

}  // namespace ziggurat::magnetism
