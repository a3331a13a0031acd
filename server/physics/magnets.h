#pragma once
// Magnetism as a plug-in: collects the magnets of all bodies, asks magnetism/ what they do to each
// other, and applies it before each substep.

#include <optional>

#include "magnetism/field.h"
#include "physics/plugin.h"

namespace ziggurat::physics {

/// A magnet, and what it moves with.
struct PlacedMagnet {
  std::size_t entity = 0;
  std::size_t part = 0;                  ///< that moves and feels the force
  std::size_t link = 0;                  ///< in whose shape it sits
  std::optional<std::size_t> turning;    ///< the link that shows its orientation
  magnetism::Magnet magnet;              ///< its body not yet numbered
  std::size_t number = 0;                ///< into Body::magnets
  std::optional<math::Quaternion> turn;  ///< where it was when the field was given up
};

class Magnets final : public Plugin {
 public:
  explicit Magnets(const scene::Magnetism& magnetism);

  void body_added(Body& body) override;
  void body_removed(const Body& body) override;
  void before_substep(std::span<Body> bodies, double substep) override;

 private:
  void give_up_field();
  void build_field();

  magnetism::Options options_;
  scene::Magnetism settings_;
  std::vector<PlacedMagnet> magnets_;
  std::vector<double> currents_;  // parallel to magnets_

  // Made when the first substep after a change begins.
  std::optional<magnetism::Field> field_;
  std::vector<std::pair<std::size_t, std::size_t>> carriers_;  // entity and part of each body
  std::vector<math::Pose> poses_;
  std::vector<magnetism::Wrench> wrenches_;
};

/// The largest rate of a bond between two bodies like one of these [rad/s], and whose it is.
/// Explicit substeps follow it while substep * rate < magnetism::stiffest_product.
struct StiffestBond {
  std::size_t entity = 0;
  double rate = 0;
};
StiffestBond stiffest_bond(std::span<const Body> bodies, const scene::Magnetism& magnetism);

}  // namespace ziggurat::physics
