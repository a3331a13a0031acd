// SPDX-License-Identifier: MIT
#pragma once
// Contact sensing: sums up the contacts of watched links.

#include <vector>

#include "physics/plugin.h"

namespace ziggurat::physics {

class ContactSensing final : public Plugin {
 public:
  void body_watched(const Body& body) override;
  void body_removed(const Body& body) override;
  bool wants_contacts(std::span<const Body> bodies) const override;
  void contact_begins(std::span<Body> bodies, const LinkContact& contact) override;
  void contact_persists(std::span<Body> bodies, const LinkContact& contact) override;

 private:
  std::vector<std::size_t> watched_;  // entities, once for each link
};

}  // namespace ziggurat::physics
