// SPDX-License-Identifier: MIT
#pragma once
// Variable precision: what a pair of magnets with shapes does beyond what their dipoles do, by as
// many sources as the tolerance asks for at that distance.

#include <cstdint>
#include <vector>

#include "magnetism/charges.h"
#include "magnetism/kernel.h"
#include "magnetism/rules.h"

namespace ziggurat::magnetism {

/// Representation of a pair, in the order of distance and cost.
enum class Level {
  point,    ///< one dipole each
  coarse,   ///< coarse rule against coarse rule
  mixed,    ///< fine rule against one dipole, both ways, less one dipole each
  fine,     ///< fine rule against fine rule
  charges,  ///< exact field over pole charges
};

/// A rule as the kernel needs it: its points padded to a multiple of four, then the centre, padded.
struct PaddedRule {
  std::vector<double> x, y, z, weight;
  std::size_t shell;  ///< entries without the centre
  double centre_weight;
};

/// Shared by all magnets of one shape.
struct ShapeClass {
  Shape shape;
  PaddedRule coarse, fine;
  Reach reach;
};

class ShapedMagnets {
 public:
  /// @param shapes        of every magnet; points and spheres are dipoles and cost nothing
  /// @param orientations  from each shape's axes to its body's
  ShapedMagnets(const std::vector<Shape>& shapes, const std::vector<math::Quaternion>& orientations,
                double tolerance);

  /// No pair farther apart than this needs more than dipoles [m].
  double reach() const { return reach_; }
  double reach(std::size_t magnet) const { return classes_[class_of_[magnet]].reach.point; }

  Level level(std::size_t first, std::size_t second, double distance) const;

  /// Wrench between the two, less that of their dipoles; positions and moments are the kernel's
  /// rows.
  /// @param rotations         of the two bodies
  /// @param minimum_distance  of the dipoles [m]
  Interaction beyond_dipoles(const Kernel& kernel, const Dipoles& dipoles, std::size_t first,
                             std::size_t second, const Eigen::Matrix3d& first_rotation,
                             const Eigen::Matrix3d& second_rotation, double minimum_distance) const;

  /// Flux density of one magnet at a point [T].
  Vector3 field(const Kernel& kernel, const Dipoles& dipoles, std::size_t magnet,
                const Eigen::Matrix3d& rotation, const Vector3& point) const;

 private:
  struct Pair {
    const Kernel& kernel;
    const Row& first_moment;
    const Row& second_moment;
    Vector3 separation = Vector3::Zero();  // first minus second centre
  };

  Eigen::Matrix3d axes(std::size_t magnet, const Eigen::Matrix3d& rotation) const;
  /// Every point of the first against all of the second. Only the first's side is summed; the
  /// torque on the second follows from the conservation law.
  Interaction between(const Pair& pair, const Points& first, const Points& second) const;
  /// The centre of each against the points of the other, likewise.
  Interaction mixed(const Pair& pair, const Points& first, const Points& second) const;
  PlacedShape placed(const Dipoles& dipoles, std::size_t magnet, const Eigen::Matrix3d& axes) const;

  double tolerance_;
  double reach_ = 0;
  std::vector<ShapeClass> classes_;
  std::vector<std::uint32_t> class_of_;  // of every magnet
  std::vector<Eigen::Matrix3d> turned_;  // shape axes to body axes, of every magnet
  std::vector<char> is_turned_;          // whether it is not the identity
};

}  // namespace ziggurat::magnetism
