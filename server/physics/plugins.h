// SPDX-License-Identifier: MIT
#pragma once
// The plug-ins of a world, and what they are told of contacts.

#include <memory>
#include <span>
#include <vector>

#include "physics/plugin.h"
#include "timing/stopwatch.h"

namespace ziggurat::physics {

class NewtonCore;

class Plugins {
 public:
  /// Makes the plug-ins that the scene chooses, and those of every world.
  Plugins(const scene::Physics& physics, NewtonCore& core);

  /// One more, which acts behind the others.
  void add(std::unique_ptr<Plugin> plugin);

  void add(Body& body);
  void remove(const Body& body);
  void move(Body& body);
  void watch(const Body& body);
  /// @param watch  gets the time of each phase; null: none
  void before_substep(std::span<Body> bodies, double substep, timing::Stopwatch* watch = nullptr);
  /// The one that has stiff pairs in the coming substep; null: none has.
  Plugin* stiff() const;
  /// Tells of contacts, then of the end.
  void after_substep(std::span<Body> bodies, double substep, const NewtonCore& core);
  void archive(math::Archive& archive, std::span<const Body> bodies);

 private:
  void tell_contacts(std::span<Body> bodies);

  std::vector<std::unique_ptr<Plugin>> plugins_;  // in the order in which they act
  std::vector<LinkContact> before_, now_;         // ascending
};

}  // namespace ziggurat::physics
