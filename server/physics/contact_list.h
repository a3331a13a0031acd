#pragma once
// Lists the contacts of a substep, while that is wanted.

#include <span>
#include <vector>

#include "physics/plugin.h"

namespace ziggurat::physics {

class ContactList final : public Plugin {
 public:
  void set_wanted(bool wanted) {
    wanted_ = wanted;
    if (!wanted) contacts_.clear();
  }
  const std::vector<Contact>& contacts() const { return contacts_; }

  void before_substep(std::span<Body>, double) override { contacts_.clear(); }
  bool wants_contacts(std::span<const Body>) const override { return wanted_; }
  void contact_begins(std::span<Body>, const Contact& contact) override {
    contacts_.push_back(contact);
  }
  void contact_persists(std::span<Body>, const Contact& contact) override {
    contacts_.push_back(contact);
  }

 private:
  bool wanted_ = false;
  std::vector<Contact> contacts_;  // of the last substep
};

}  // namespace ziggurat::physics
