#pragma once
// What contact sensors feel: sums up how the watched links are touched.

#include "physics/plugin.h"

namespace ziggurat::physics {

class ContactSensing final : public Plugin {
 public:
  bool wants_contacts(std::span<const Body> bodies) const override;
  void contact_begins(std::span<Body> bodies, const LinkContact& contact) override;
  void contact_persists(std::span<Body> bodies, const LinkContact& contact) override;
};

}  // namespace ziggurat::physics
