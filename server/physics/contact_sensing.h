// SPDX-License-Identifier: MIT
#pragma once
// Contact sensing: sums up the contacts of watched links.

#include "physics/plugin.h"

namespace ziggurat::physics {

class ContactSensing final : public Plugin {
 public:
  bool wants_contacts(std::span<const Body> bodies) const override;
  void contact_begins(std::span<Body> bodies, const LinkContact& contact) override;
  void contact_persists(std::span<Body> bodies, const LinkContact& contact) override;
};

}  // namespace ziggurat::physics
