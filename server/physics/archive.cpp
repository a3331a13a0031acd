// SPDX-License-Identifier: MIT
// The state of bodies and of what acts on them: all that the next substep reads.

#include "physics/archive.h"

#include "physics/magnets.h"
#include "physics/plugins.h"

namespace ziggurat::physics {

void LinkBody::archive(math::Archive& archive) {
  archive("placed", placed);
  archive("turn", turn);
  archive("spin", spin);
  if (!touch) return;
  archive("touched", touch->touched);
  archive("impulse", touch->impulse);
  archive("magnitude", touch->magnitude);
}

void FlightTarget::archive(math::Archive& archive) {
  archive("holds_position", holds_position);
  archive("position", position);
  archive("velocity", velocity);
  archive("holds_heading", holds_heading);
  archive("heading", heading);
  archive("turn_rate", turn_rate);
}

void Body::archive(math::Archive& archive) {
  archive("placed", placed);
  archive("links", links);
  for (Magnet& magnet : magnets) archive("current", magnet.current);
  if (ground) {
    archive("velocity", ground->velocity);
    archive("angular_velocity", ground->angular_velocity);
  }
  if (turret) {
    archive("follows", turret->follows);
    archive("speed", turret->speed);
    archive("angle", turret->angle);
  }
  if (flight) flight->target.archive(archive);
}

namespace {

void archive_side(math::Archive& archive, ContactSide& side, std::span<const Body> bodies) {
  archive("entity", side.entity);
  archive("link", side.link);
  if (side.entity == ContactSide::floor) return;
  archive.require(side.entity < bodies.size(), "is beyond its list");
  const std::size_t links = bodies[side.entity].links.size();
  archive.require(links == 0 || side.link < links, "is beyond its list");  // 0: removed since
}

}  // namespace

void Plugins::archive(math::Archive& archive, std::span<const Body> bodies) {
  for (auto& plugin : plugins_) plugin->archive(archive, bodies);
  archive.list("touching", now_, [&](LinkContact& contact) {
    archive_side(archive, contact.a, bodies);
    archive_side(archive, contact.b, bodies);
    archive("normal", contact.normal);
    archive("point", contact.point);
    archive("impulse", contact.impulse);
  });
}

void Need::archive(math::Archive& archive) {
  archive("misplaced", misplaced);
  archive("parts_squared", parts_squared);
  archive("fewest_parts", fewest_parts);
}

void Carrier::archive(math::Archive& archive) {
  archive("rests", rests);
  archive("seen", seen);
  archive("centre", centre);
  archive("velocity", velocity);
  archive("turning", turning);
  archive("need", need);
  archive("seen_before", seen_before);
  archive("velocity_before", velocity_before);
  archive("turning_before", turning_before);
}

void Magnets::archive(math::Archive& archive, std::span<const Body> bodies) {
  archive("currents", currents_);
  for (PlacedMagnet& magnet : magnets_) archive("turn", magnet.turn);
  archive("substeps", substeps_);
  archive("quiet", quiet_);
  bool has_field = field_.has_value();
  archive("has_field", has_field);
  if (archive.reads()) {
    if (!has_field) field_.reset();
    if (has_field && !field_) build_field(bodies);
  }
  if (!field_) return;
  std::vector<math::Quaternion> turns(field_->turns().begin(), field_->turns().end());
  archive("turns", turns);
  if (archive.reads()) field_->set_turns(turns);
  archive("carriers", carriers_);
  archive("poses", poses_);
  for (magnetism::Wrench& wrench : wrenches_) {
    archive("force", wrench.force);
    archive("torque", wrench.torque);
  }
  archive("evaluated", evaluated_);
}

}  // namespace ziggurat::physics
