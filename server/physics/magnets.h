#pragma once
// Magnetism as a plug-in: collects the magnets of all bodies, asks magnetism/ what they do to each
// other, and applies it before each substep.

#include <optional>

#include "magnetism/field.h"
#include "physics/plugin.h"

namespace ziggurat::physics {

class Magnets final : public Plugin {
 public:
  explicit Magnets(const scene::Magnetism& magnetism);

  void body_added(const Body& body) override;
  void body_removed(const Body& body) override;
  void before_substep(std::span<Body> bodies, double substep) override;

  /// @param currents  of all magnets that were ever added, in the order of their bodies
  void set_currents(std::span<const double> currents);

  /// The largest rate of a bond between two bodies like one of these [rad/s], and whose it is.
  /// Explicit substeps follow it while substep * rate < magnetism::stiffest_product.
  struct Stiffest {
    std::size_t entity = 0;
    double rate = 0;
  };
  Stiffest stiffest_bond(std::span<const Body> bodies) const;

 private:
  /// A magnet, and what it moves with.
  struct Placed {
    std::size_t entity = 0;
    std::size_t part = 0;                  ///< that moves and feels the force
    std::size_t link = 0;                  ///< in whose shape it sits
    std::optional<std::size_t> turning;    ///< the link that shows its orientation
    magnetism::Magnet magnet;              ///< its body not yet numbered
    std::size_t number = 0;                ///< among all that were ever added
    std::optional<math::Quaternion> turn;  ///< where it was when the field was given up
  };

  Placed place(const Body& body, const scene::Magnet& magnet) const;
  double stiffest_rate(const Body& body, std::size_t link) const;
  void give_up_field();
  void build_field();

  magnetism::Options options_;
  scene::Magnetism settings_;
  std::vector<Placed> magnets_;
  std::vector<double> currents_;  // parallel to magnets_
  std::size_t added_ = 0;         // magnets

  // Made when the first substep after a change begins.
  std::optional<magnetism::Field> field_;
  std::vector<std::pair<std::size_t, std::size_t>> carriers_;  // entity and part of each body
  std::vector<math::Pose> poses_;
  std::vector<magnetism::Wrench> wrenches_;
};

}  // namespace ziggurat::physics
