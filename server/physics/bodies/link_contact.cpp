// SPDX-License-Identifier: MIT
#include "physics/bodies/link_contact.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace ziggurat::physics {

LinkContact in_order(LinkContact contact) {
  if (contact.b < contact.a) {
    std::swap(contact.a, contact.b);
    contact.normal = -contact.normal;
    contact.impulse = -contact.impulse;
  }
  return contact;
}

void sort(std::vector<LinkContact>& contacts) {
  std::ranges::sort(contacts, {}, [](const LinkContact& each) { return std::tie(each.a, each.b); });
}

}  // namespace ziggurat::physics
