// SPDX-License-Identifier: MIT
#include "physics/magnets.h"

#include <algorithm>
#include <utility>

#include "magnetism/stiffness.h"
#include "physics/bodies/convert.h"
#include "physics/magnet_source.h"

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
  placed.magnet.core = body.magnets[number].core;
  return placed;
}

/// The rate of the stiffest bond of a link's faces, with the mass of all that moves with it. In the
/// link's axes about the part's centre of mass.
/// @param of_body  all magnets of the body
/// @param fixed    of them those that are fixed count, or else those that turn freely
double stiffest_rate(const Body& body, std::size_t number, std::span<const PlacedMagnet> of_body,
                     bool fixed) {
  const LinkBody& link = body.links[number];
  const Part& part = body.parts[link.part];
  if (!part.moves) return 0;
  const Eigen::Matrix3d into = link.in_part.orientation.conjugate().toRotationMatrix();
  std::vector<magnetism::Magnet> magnets;
  for (const PlacedMagnet& placed : of_body) {
    if (placed.link != number || placed.turning.has_value() == fixed) continue;
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

PairOfMagnets pair_of(const magnetism::Field& field, std::size_t i, std::size_t j) {
  PairOfMagnets pair;
  pair.moments = field.moment(i).norm() * field.moment(j).norm();
  pair.first = field.position(i);
  pair.second = field.position(j);
  pair.closest = field.core(i) + field.core(j);
  pair.distance = std::max({(pair.first - pair.second).norm(), pair.closest, 1e-6});
  return pair;
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

void Magnets::body_moved(Body& body) {
  for (Carrier& carrier : carriers_) {
    if (carrier.entity == body.entity) carrier.rests = false;
  }
}

/// The next one goes on with the orientations of this one.
void Magnets::give_up_field() {
  for (std::size_t i = 0; field_ && i < magnets_.size(); ++i) {
    if (magnets_[i].turning) magnets_[i].turn = field_->turns()[i];
  }
  field_.reset();
}

void Magnets::build_field(std::span<const Body> bodies) {
  carriers_.clear();
  std::vector<magnetism::Magnet> magnets;
  std::ptrdiff_t first = 0;  // carrier of the entity under way: magnets of an entity stand together
  for (const PlacedMagnet& placed : magnets_) {
    if (!carriers_.empty() && carriers_.back().entity != placed.entity)
      first = std::ssize(carriers_);
    const auto found =
        std::find_if(carriers_.begin() + first, carriers_.end(),
                     [&](const Carrier& carrier) { return carrier.part == placed.part; });
    magnets.push_back(placed.magnet);
    magnets.back().body = static_cast<std::uint32_t>(found - carriers_.begin());
    if (found == carriers_.end()) {
      carriers_.push_back({.entity = placed.entity, .part = placed.part});
    }
  }
  poses_.resize(carriers_.size());
  wrenches_.resize(carriers_.size());
  evaluated_ = false;
  field_.emplace(std::move(magnets), carriers_.size(), options_);
  weigh_carriers(bodies);
  std::vector<Quaternion> turns(field_->turns().begin(), field_->turns().end());
  for (std::size_t i = 0; i < magnets_.size(); ++i) turns[i] = magnets_[i].turn.value_or(turns[i]);
  field_->set_turns(turns);
}

/// Takes the poses of the carriers, and the currents.
/// @return  whether something differs from what it was
bool Magnets::take_poses(std::span<const Body> bodies) {
  bool changed = false;
  for (std::size_t i = 0; i < magnets_.size(); ++i) {
    const double current = bodies[magnets_[i].entity].magnets[magnets_[i].number].current;
    changed |= std::exchange(currents_[i], current) != current;
  }
  for (std::size_t i = 0; i < carriers_.size(); ++i) {
    Carrier& carrier = carriers_[i];
    const Body& body = bodies[carrier.entity];
    const bool rested = std::exchange(carrier.rests, body.sleeps());
    if (rested && carrier.rests) continue;
    const Pose pose = from_bullet(body.transform(carrier.part));
    const bool same = pose.position == poses_[i].position &&
                      pose.orientation.coeffs() == poses_[i].orientation.coeffs();
    changed |= !same;
    poses_[i] = pose;
  }
  return changed;
}

void Magnets::before_substep(std::span<Body> bodies, double substep) {
  stiff_.clear();
  if (magnets_.empty()) return;
  if (!field_) build_field(bodies);
  const bool changed = take_poses(bodies);
  if (changed || !evaluated_ || field_->turns_freely()) {
    ++substeps_;
    field_->evaluate(substep, poses_, currents_, wrenches_);
    evaluated_ = true;
    find_close_pairs(bodies, substep);
    quiet_ = false;
  } else {
    quiet_ = true;
  }
  for (std::size_t i = 0; i < carriers_.size(); ++i) push(bodies, i, 1);
  for (std::size_t i = 0; i < magnets_.size(); ++i) {
    if (!magnets_[i].turning) continue;
    bodies[magnets_[i].entity].links[*magnets_[i].turning].turn = field_->turns()[i];
  }
}

void Magnets::push(std::span<Body> bodies, std::size_t carrier, double share) const {
  const std::size_t part = carriers_[carrier].part;
  Body& body = bodies[carriers_[carrier].entity];
  if (!body.parts[part].moves) return;
  body.apply_force(part, to_bullet(math::Vector3(share * wrenches_[carrier].force)));
  body.apply_torque(part, to_bullet(math::Vector3(share * wrenches_[carrier].torque)));
}

void Magnets::weigh_carriers(std::span<const Body> bodies) {
  felt_inverse_mass_ = inverse_inertia_ = 0;
  for (Carrier& carrier : carriers_) {
    const Part& part = bodies[carrier.entity].parts[carrier.part];
    if (!part.moves) continue;
    carrier.inverse_mass = 1 / part.mass;
    carrier.inverse_inertia = 1 / part.inertia.minCoeff();
  }
  for (const magnetism::Magnet& magnet : field_->magnets()) {
    const Carrier& carrier = carriers_[magnet.body];
    const double felt =
        carrier.inverse_mass + magnet.position.squaredNorm() * carrier.inverse_inertia;
    felt_inverse_mass_ = std::max(felt_inverse_mass_, felt);
    inverse_inertia_ = std::max(inverse_inertia_, carrier.inverse_inertia);
  }
}

/// Notes how a carrier moves, once in a substep.
void Magnets::note_motion(Carrier& carrier, const Body& body) {
  if (carrier.seen == substeps_) return;
  carrier.seen_before = carrier.seen;
  carrier.velocity_before = carrier.velocity;
  carrier.turning_before = carrier.turning;
  if (quiet_) {  // what does not change its place has no speed
    carrier.velocity_before.setZero();
    carrier.turning_before.setZero();
  }
  carrier.seen = substeps_;
  carrier.need = {};
  carrier.centre = poses_[&carrier - carriers_.data()].position;
  if (carrier.inverse_mass == 0) return;
  body.motions(motions_);
  carrier.velocity = from_bullet(motions_[carrier.part].velocity);
  carrier.turning = from_bullet(motions_[carrier.part].angular_velocity);
}

/// Freely turning magnets are left out: their orientations relax, they keep no energy.
void Magnets::find_close_pairs(std::span<const Body> bodies, double substep) {
  double moment = 0;
  for (std::size_t i = 0; i < magnets_.size(); ++i) {
    if (!magnets_[i].turning) moment = std::max(moment, field_->moment(i).norm());
  }
  close_.clear();
  if (moment == 0) return;  // a list of pairs at no distance would take as long as one of all
  field_->list_near(close_reach(moment, felt_inverse_mass_, inverse_inertia_, substep), near_);
  const auto carrier = [&](std::uint32_t magnet) -> Carrier& {
    return carriers_[field_->magnets()[magnet].body];
  };
  for (const auto& [i, j] : near_) {
    Carrier &a = carrier(i), &b = carrier(j);
    if (magnets_[i].turning || magnets_[j].turning || a.entity == b.entity) continue;
    if (a.inverse_mass + b.inverse_mass == 0) continue;
    note_motion(a, bodies[a.entity]);
    note_motion(b, bodies[b.entity]);
    const auto need = need_of(pair_of(*field_, i, j), a, b, substep, substeps_);
    if (!need) continue;
    close_.push_back({i, j, *need});
    a.need += *need;
    b.need += *need;
  }
  for (const ClosePair& pair : close_) {
    const Carrier &a = carrier(pair.first), &b = carrier(pair.second);
    const int parts = parts_for(pair.need, a, b);
    if (parts > 0) stiff_.push_back({a.entity, b.entity, parts});
  }
}

void Magnets::choose_stiff(std::span<const std::uint8_t> entities) {
  chosen_pairs_.clear();
  for (const ClosePair& pair : close_) {
    const Carrier& a = carriers_[field_->magnets()[pair.first].body];
    const Carrier& b = carriers_[field_->magnets()[pair.second].body];
    const bool counts =
        (entities[a.entity] || a.inverse_mass == 0) && (entities[b.entity] || b.inverse_mass == 0);
    if (counts && (entities[a.entity] || entities[b.entity])) {
      chosen_pairs_.emplace_back(pair.first, pair.second);
    }
  }
  chosen_.assign(chosen_pairs_);
  chosen_carriers_.clear();
  for (const std::uint32_t magnet : chosen_.magnets()) {
    chosen_carriers_.push_back(field_->magnets()[magnet].body);
  }
  std::sort(chosen_carriers_.begin(), chosen_carriers_.end());
  chosen_carriers_.erase(std::unique(chosen_carriers_.begin(), chosen_carriers_.end()),
                         chosen_carriers_.end());
}

void Magnets::push_stiff(std::span<Body> bodies, double share) {
  for (const std::size_t i : chosen_carriers_) {
    poses_[i] = from_bullet(bodies[carriers_[i].entity].transform(carriers_[i].part));
  }
  field_->evaluate(chosen_, poses_, currents_, wrenches_);
  evaluated_ = false;
  for (const std::size_t i : chosen_carriers_) push(bodies, i, share);
}

StiffestBond stiffest_bond(std::span<const Body> bodies, const scene::Magnetism& magnetism) {
  StiffestBond stiffest;
  for (const Body& body : bodies) {
    std::vector<PlacedMagnet> magnets;
    for (std::size_t i = 0; i < body.magnets.size(); ++i) {
      magnets.push_back(place(body, i, magnetism));
    }
    for (std::size_t i = 0; i < body.links.size() && !magnets.empty(); ++i) {
      for (const bool fixed : {false, true}) {
        const double rate = stiffest_rate(body, i, magnets, fixed);
        const double safe = fixed ? safe_divided : magnetism::stiffest_product;
        if (rate / safe > stiffest.rate / stiffest.safe) stiffest = {body.entity, rate, safe};
      }
    }
  }
  return stiffest;
}

}  // namespace ziggurat::physics
