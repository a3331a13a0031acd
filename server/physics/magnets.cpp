#include "physics/magnets.h"

#include <algorithm>

#include "magnetism/stiffness.h"
#include "physics/convert.h"
#include "physics/magnet_source.h"
#include "physics/turning_magnets.h"

namespace ziggurat::physics {

using math::Pose;
using math::Quaternion;
using math::Vector3;

Magnets::Magnets(const scene::Magnetism& magnetism) : settings_(magnetism) {
  if (magnetism.max_distance) options_.max_distance = *magnetism.max_distance;
  if (magnetism.adaptive) options_.precision = magnetism::Precision::adaptive;
  options_.tolerance = magnetism.tolerance;
  options_.taper = magnetism.taper;
}

/// A magnet in the frame of the centre of mass of the link it moves with.
Magnets::Placed Magnets::place(const Body& body, const scene::Magnet& magnet) const {
  Placed placed;
  placed.entity = body.entity;
  const bool on_origin = magnet.anchor.link == scene::Anchor::origin;
  const std::size_t anchor =
      on_origin ? body.reference_link : static_cast<std::size_t>(magnet.anchor.link);
  const LinkBody& link = body.links[anchor];
  Pose in_link;  // of the anchor frame, seen from the link's centre of mass
  in_link.position = -link.center_of_mass;
  if (on_origin) in_link = in_link * body.origin_from_reference;
  placed.link = anchor;
  Pose in_mover = in_link;
  if (link.carrier != LinkBody::carries_itself) {
    placed.link = static_cast<std::size_t>(link.carrier);
    in_mover = from_bullet(link.in_carrier) * in_link;
    if (turns_freely(link, magnet)) placed.turning = anchor;
  }
  placed.magnet.position = in_mover * magnet.offset;
  placed.magnet.shape = shape_of(magnet);
  if (magnet.shape) {
    placed.magnet.orientation = in_mover.orientation * magnet.shape->orientation;
  }
  placed.magnet.passive_moment = in_mover.orientation * passive_moment(magnet, settings_);
  placed.magnet.active_moment = in_mover.orientation * active_moment(magnet, settings_);
  placed.magnet.freely_turning = placed.turning.has_value();
  return placed;
}

void Magnets::body_added(const Body& body) {
  for (const scene::Magnet& magnet : body.magnets) {
    magnets_.push_back(place(body, magnet));
    currents_.push_back(0);
  }
  field_.reset();
}

void Magnets::body_removed(const Body& body) {
  for (std::size_t i = magnets_.size(); i-- > 0;) {
    if (magnets_[i].entity != body.entity) continue;
    magnets_.erase(magnets_.begin() + static_cast<std::ptrdiff_t>(i));
    currents_.erase(currents_.begin() + static_cast<std::ptrdiff_t>(i));
  }
  field_.reset();
}

void Magnets::build_field() {
  carriers_.clear();
  std::vector<magnetism::Magnet> magnets;
  for (const Placed& placed : magnets_) {
    const std::pair carrier(placed.entity, placed.link);
    auto found = std::find(carriers_.begin(), carriers_.end(), carrier);
    if (found == carriers_.end()) found = carriers_.insert(carriers_.end(), carrier);
    magnets.push_back(placed.magnet);
    magnets.back().body = static_cast<std::uint32_t>(found - carriers_.begin());
  }
  poses_.resize(carriers_.size());
  wrenches_.resize(carriers_.size());
  field_.emplace(std::move(magnets), carriers_.size(), options_);
}

void Magnets::before_substep(std::span<Body> bodies, double substep) {
  if (magnets_.empty()) return;
  if (!field_) build_field();
  for (std::size_t i = 0; i < carriers_.size(); ++i) {
    poses_[i] = from_bullet(bodies[carriers_[i].first].links[carriers_[i].second].transform());
  }
  field_->evaluate(substep, poses_, currents_, wrenches_);
  for (std::size_t i = 0; i < carriers_.size(); ++i) {
    const LinkBody& link = bodies[carriers_[i].first].links[carriers_[i].second];
    if (!link.moves) continue;
    link.apply_force(to_bullet(wrenches_[i].force));
    link.apply_torque(to_bullet(wrenches_[i].torque));
  }
  for (std::size_t i = 0; i < magnets_.size(); ++i) {
    if (!magnets_[i].turning) continue;
    bodies[magnets_[i].entity].links[*magnets_[i].turning].turn = field_->turns()[i];
  }
}

Magnets::Stiffest Magnets::stiffest_bond(std::span<const Body> bodies) {
  Stiffest stiffest;
  if (magnets_.empty()) return stiffest;
  if (!field_) build_field();
  for (std::size_t i = 0; i < carriers_.size(); ++i) {
    const auto& [entity, link] = carriers_[i];
    const LinkBody& body = bodies[entity].links[link];
    if (!body.moves) continue;
    const magnetism::BondedBody bonded{body.half_extents, Vector3::Zero(), body.mass, body.inertia};
    const double rate =
        magnetism::stiffest_rate(field_->magnets(), static_cast<std::uint32_t>(i), bonded);
    if (rate > stiffest.rate) stiffest = {entity, rate};
  }
  return stiffest;
}

void Magnets::set_currents(std::span<const double> currents) {
  currents_.assign(currents.begin(), currents.end());
}

}  // namespace ziggurat::physics
