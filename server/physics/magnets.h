// SPDX-License-Identifier: MIT
#pragma once
// Magnetism as a plug-in: collects the magnets of all bodies, asks magnetism/ what they do to each
// other, and applies it before each substep.

#include <optional>

#include "magnetism/field.h"
#include "physics/plugin.h"
#include "physics/stiff_magnets.h"

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

  timing::Phase phase() const override { return timing::Phase::magnetism; }

  void body_added(Body& body) override;
  void body_removed(const Body& body) override;
  void body_moved(Body& body) override;
  void before_substep(std::span<Body> bodies, double substep) override;

  std::span<const StiffPair> stiff_pairs() const override { return stiff_; }
  void choose_stiff(std::span<const std::uint8_t> entities) override;
  void push_stiff(std::span<Body> bodies, double share) override;
  void archive(math::Archive& archive, std::span<const Body> bodies) override;

 private:
  void give_up_field();
  void build_field(std::span<const Body> bodies);
  void weigh_carriers(std::span<const Body> bodies);
  bool take_poses(std::span<const Body> bodies);
  void find_close_pairs(std::span<const Body> bodies, double substep);
  void note_motion(Carrier& carrier, const Body& body);
  void push(std::span<Body> bodies, std::size_t carrier, double share) const;

  magnetism::Options options_;
  scene::Magnetism settings_;
  std::vector<PlacedMagnet> magnets_;
  std::vector<double> currents_;  // parallel to magnets_

  // Made when the first substep after a change begins.
  std::optional<magnetism::Field> field_;
  std::vector<Carrier> carriers_;  // the bodies of the field
  std::vector<math::Pose> poses_;
  std::vector<magnetism::Wrench> wrenches_;
  bool evaluated_ = false;  // wrenches_ are those at poses_ and currents_

  // Pairs for which a substep is divided.
  std::uint64_t substeps_ = 0;                          // without quiet ones
  bool quiet_ = false;                                  // nothing had changed in the substep before
  double felt_inverse_mass_ = 0, inverse_inertia_ = 0;  // the largest of the carriers
  std::vector<magnetism::MagnetPair> near_, chosen_pairs_;
  std::vector<ClosePair> close_;  // of the last one of these
  std::vector<StiffPair> stiff_;  // of them those for which the substep must be divided
  magnetism::PairSet chosen_;
  std::vector<std::size_t> chosen_carriers_;
  std::vector<Twist> motions_;
};

/// The bond between two bodies like one of these that needs the shortest substeps.
struct StiffestBond {
  std::size_t entity = 0;  ///< whose it is
  double rate = 0;         ///< see magnetism/stiffness.h [rad/s]
  double safe = 1;         ///< substeps are short enough while substep * rate is below this
};
StiffestBond stiffest_bond(std::span<const Body> bodies, const scene::Magnetism& magnetism);

}  // namespace ziggurat::physics
