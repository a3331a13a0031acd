#pragma once
// The plug-in layer: what acts on bodies besides joints and contacts. Floor, gravity, damping
// and magnetism are plug-ins; each sees bodies come and go and adds forces before a substep.

#include <span>

#include "physics/bodies.h"

namespace ziggurat::physics {

class Plugin {
 public:
  virtual ~Plugin() = default;
  virtual void body_added(const Body&) {}
  virtual void body_removed(const Body&) {}
  /// Called before each substep with the poses at its beginning; forces last for it.
  /// @param substep  its length [s]
  virtual void before_substep(std::span<Body> bodies, double substep) = 0;
};

}  // namespace ziggurat::physics
