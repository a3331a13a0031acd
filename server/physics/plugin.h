// SPDX-License-Identifier: MIT
#pragma once
// The plug-in layer: what acts on bodies besides joints and contacts, and what watches them.
// Damping, magnetism, wheels, flight and contact sensing are plug-ins. physics/plugins.cpp lists
// them.

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "physics/bodies/bodies.h"
#include "physics/bodies/link_contact.h"
#include "timing/phases.h"

namespace ziggurat::math {
class Archive;
}

namespace ziggurat::physics {

/// Two entities, of which at least one moves, between which forces change so fast that the substep
/// must be divided for them.
struct StiffPair {
  std::size_t a = 0, b = 0;  ///< in order of adding
  int parts = 1;             ///< into so many; > 0
};

/// Every function may do nothing. They are called in the order of a substep.
class Plugin {
 public:
  virtual ~Plugin() = default;

  /// The phase of a tick that its forces belong to.
  virtual timing::Phase phase() const { return timing::Phase::forces; }

  virtual void body_added(Body&) {}
  virtual void body_removed(const Body&) {}  ///< it still has its links
  virtual void body_moved(Body&) {}          ///< put to rest elsewhere, as if placed there
  virtual void body_watched(const Body&) {}  ///< contacts of one more of its links are wanted

  /// Called with the poses at the substep's beginning; forces last for it.
  /// @param substep  its length [s]
  virtual void before_substep(std::span<Body> /*bodies*/, double /*substep*/) {}

  /// Stiff pairs of the coming substep, after before_substep(). A core may divide the substep for
  /// them. It then calls choose_stiff() once for each set of entities, and push_stiff() in each
  /// part.
  virtual std::span<const StiffPair> stiff_pairs() const { return {}; }
  /// Chooses the forces that these entities exert on each other, and that what stands exerts.
  /// @param entities  of each whether it belongs to the set
  virtual void choose_stiff(std::span<const std::uint8_t> /*entities*/) {}
  /// Applies the chosen forces at the poses of now, times `share`. before_substep() has applied
  /// them once.
  virtual void push_stiff(std::span<Body> /*bodies*/, double /*share*/) {}

  /// Contacts cost time: they are reported only if a plug-in asks for them.
  virtual bool wants_contacts(std::span<const Body> /*bodies*/) const { return false; }
  /// Contact events: each touching pair is reported once in a substep, in ascending order of a and
  /// b. It has begun if it did not touch in the substep before, otherwise it persists. Then ended
  /// pairs follow, as they last were; one of their bodies may have been removed.
  virtual void contact_begins(std::span<Body> /*bodies*/, const LinkContact&) {}
  virtual void contact_persists(std::span<Body> /*bodies*/, const LinkContact&) {}
  virtual void contact_ends(std::span<Body> /*bodies*/, const LinkContact&) {}

  /// Called with the poses at the substep's end, after its contacts.
  virtual void after_substep(std::span<Body> /*bodies*/, double /*substep*/) {}

  /// Archives the state that the next substep reads beyond the bodies. @param bodies  as they are
  /// then
  virtual void archive(math::Archive& /*archive*/, std::span<const Body> /*bodies*/) {}
};

}  // namespace ziggurat::physics
