// SPDX-License-Identifier: MIT
#include "physics/contact_sensing.h"

namespace ziggurat::physics {
namespace {

/// @param impulse  on this side [N s]
void add(std::span<Body> bodies, const ContactSide& side, const math::Vector3& impulse) {
  if (side.entity == ContactSide::floor) return;
  LinkBody& link = bodies[side.entity].links[side.link];
  if (!link.touch) return;
  link.touch->touched = true;
  link.touch->impulse += impulse;
  link.touch->magnitude += impulse.norm();
}

}  // namespace

void ContactSensing::body_watched(const Body& body) { watched_.push_back(body.entity); }

void ContactSensing::body_removed(const Body& body) { std::erase(watched_, body.entity); }

bool ContactSensing::wants_contacts(std::span<const Body> /*bodies*/) const {
  return !watched_.empty();
}

void ContactSensing::contact_begins(std::span<Body> bodies, const LinkContact& contact) {
  add(bodies, contact.a, contact.impulse);
  add(bodies, contact.b, -contact.impulse);
}

void ContactSensing::contact_persists(std::span<Body> bodies, const LinkContact& contact) {
  contact_begins(bodies, contact);
}

}  // namespace ziggurat::physics
