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

namespace {

/// A magnet in the frame of the part that it moves with.
PlacedMagnet place(const Body& body, std::size_t number, const scene::Magnetism& magnetism) {
  const scene::Magnet& magnet = body.magnets[number].scene;
  PlacedMagnet placed;
  placed.number = number;
  placed.entity = body.entity;
  const bool on_origin = magnet.anchor.link == scene::Anchor::origin;
  placed.link = on_origin ? body.reference_link : static_cast<std::size_t>(magnet.anchor.link);
  const LinkBody& link = body.links[placed.link];
  placed.part = link.part;
  Pose in_mover = link.frame_in_part();  // the anchor frame
  if (on_origin) in_mover = in_mover * body.origin_from_reference;
  if (turns_freely(link, magnet)) {
    placed.turning = placed.link;
    placed.link = static_cast<std::size_t>(link.carrier);
  }
  placed.magnet.position = in_mover * magnet.offset;
  placed.magnet.shape = shape_of(magnet);
  if (magnet.shape) {
    placed.magnet.orientation = in_mover.orientation * magnet.shape->orientation;
  }
  placed.magnet.passive_moment = in_mover.orientation * passive_moment(magnet, magnetism);
  placed.magnet.active_moment = in_mover.orientation * active_moment(magnet, magnetism);
  placed.magnet.freely_turning = placed.turning.has_value();
  return placed;
}

/// The rate of the stiffest bond of a link's faces, with the mass of all that moves with it. In the
/// link's axes about the part's centre of mass.
/// @param of_body  all magnets of the body
double stiffest_rate(const Body& body, std::size_t number, std::span<const PlacedMagnet> of_body) {
  const LinkBody& link = body.links[number];
  const Part& part = body.parts[link.part];
  if (!part.moves) return 0;
  const Eigen::Matrix3d into = link.in_part.orientation.conjugate().toRotationMatrix();
  std::vector<magnetism::Magnet> magnets;
  for (const PlacedMagnet& placed : of_body) {
    if (placed.link != number) continue;
    magnets.push_back(placed.magnet);
    magnets.back().position = into * placed.magnet.position;
  }
  if (magnets.empty()) return 0;
  const Eigen::Matrix3d inertia = into * part.inertia.asDiagonal() * into.transpose();
  return magnetism::stiffest_rate(magnets, 0,
                                  {.half_extents = link.half_extents,
                                   .offset = into * link.in_part.position,
                                   .mass = part.mass,
                                   .inertia = inertia.diagonal()});
}

}  // namespace

Magnets::Magnets(const scene::Magnetism& magnetism) : settings_(magnetism) {
  if (magnetism.max_distance) options_.max_distance = *magnetism.max_distance;
  if (magnetism.adaptive) options_.precision = magnetism::Precision::adaptive;
  options_.tolerance = magnetism.tolerance;
  options_.taper = magnetism.taper;
}

void Magnets::body_added(Body& body) {
  if (body.magnets.empty()) return;
  give_up_field();
  for (std::size_t i = 0; i < body.magnets.size(); ++i) {
    magnets_.push_back(place(body, i, settings_));
  }
  currents_.resize(magnets_.size());
}

void Magnets::body_removed(const Body& body) {
  if (body.magnets.empty()) return;
  give_up_field();
  std::erase_if(magnets_, [&](const PlacedMagnet& each) { return each.entity == body.entity; });
  currents_.resize(magnets_.size());
}

/// The next one goes on with the orientations of this one.
void Magnets::give_up_field() {
  for (std::size_t i = 0; field_ && i < magnets_.size(); ++i) {
    if (magnets_[i].turning) magnets_[i].turn = field_->turns()[i];
  }
  field_.reset();
}

void Magnets::build_field() {
  carriers_.clear();
  std::vector<magnetism::Magnet> magnets;
  for (const PlacedMagnet& placed : magnets_) {
    const std::pair carrier(placed.entity, placed.part);
    auto found = std::find(carriers_.begin(), carriers_.end(), carrier);
    if (found == carriers_.end()) found = carriers_.insert(carriers_.end(), carrier);
    magnets.push_back(placed.magnet);
    magnets.back().body = static_cast<std::uint32_t>(found - carriers_.begin());
  }
  poses_.resize(carriers_.size());
  wrenches_.resize(carriers_.size());
  field_.emplace(std::move(magnets), carriers_.size(), options_);
  std::vector<Quaternion> turns(field_->turns().begin(), field_->turns().end());
  for (std::size_t i = 0; i < magnets_.size(); ++i) turns[i] = magnets_[i].turn.value_or(turns[i]);
  field_->set_turns(turns);
}

void Magnets::before_substep(std::span<Body> bodies, double substep) {
  if (magnets_.empty()) return;
  if (!field_) build_field();
  for (std::size_t i = 0; i < magnets_.size(); ++i) {
    currents_[i] = bodies[magnets_[i].entity].magnets[magnets_[i].number].current;
  }
  for (std::size_t i = 0; i < carriers_.size(); ++i) {
    const auto [entity, part] = carriers_[i];
    poses_[i] = from_bullet(bodies[entity].transform(part));
  }
  field_->evaluate(substep, poses_, currents_, wrenches_);
  for (std::size_t i = 0; i < carriers_.size(); ++i) {
    const auto [entity, part] = carriers_[i];
    Body& body = bodies[entity];
    if (!body.parts[part].moves) continue;
    body.apply_force(part, to_bullet(wrenches_[i].force));
    body.apply_torque(part, to_bullet(wrenches_[i].torque));
  }
  for (std::size_t i = 0; i < magnets_.size(); ++i) {
    if (!magnets_[i].turning) continue;
    bodies[magnets_[i].entity].links[*magnets_[i].turning].turn = field_->turns()[i];
  }
}

StiffestBond stiffest_bond(std::span<const Body> bodies, const scene::Magnetism& magnetism) {
  StiffestBond stiffest;
  for (const Body& body : bodies) {
    std::vector<PlacedMagnet> magnets;
    for (std::size_t i = 0; i < body.magnets.size(); ++i) {
      magnets.push_back(place(body, i, magnetism));
    }
    for (std::size_t i = 0; i < body.links.size(); ++i) {
      const double rate = stiffest_rate(body, i, magnets);
      if (rate > stiffest.rate) stiffest = {body.entity, rate};
    }
  }
  return stiffest;
}

}  // namespace ziggurat::physics
