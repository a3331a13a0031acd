#include "physics/plugin.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace ziggurat::physics {

Contact in_order(Contact contact) {
  if (contact.b < contact.a) {
    std::swap(contact.a, contact.b);
    contact.normal = -contact.normal;
    contact.impulse = -contact.impulse;
  }
  return contact;
}

void sort(std::vector<Contact>& contacts) {
  std::ranges::sort(contacts, {}, [](const Contact& each) { return std::tie(each.a, each.b); });
}

}  // namespace ziggurat::physics
