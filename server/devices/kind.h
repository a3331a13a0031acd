// SPDX-License-Identifier: MIT
#pragma once
// A kind of device: what all devices of the kind do in a tick.

#include <memory>

#include "devices/carrier.h"
#include "devices/tick.h"

namespace ziggurat::math {
class Archive;
}

namespace ziggurat::devices {

/// Every function may do nothing. None of those of a tick allocates once sizes repeat.
class Kind {
 public:
  virtual ~Kind() = default;

  /// A copy to go back to if devices can't be added.
  virtual std::unique_ptr<Kind> clone() const = 0;

  /// Appends the devices that an entity carries to their list. Left out is what has no effect
  /// because no controller enables it, unless others perceive it.
  /// @param robot  gets the range of what its controller enables
  virtual void lay_out(const Carrier& /*carrier*/, world::RobotLayout& /*robot*/,
                       world::Layout& /*layout*/) const {}

  /// Takes in the devices of new robots, at the start those of all.
  virtual void add(const Setting& /*setting*/) {}

  /// Gives commands and observations their length and new devices their initial values. What others
  /// command and show stays.
  virtual void start(Tick& /*tick*/) {}

  /// Before physics: what was commanded takes effect, at the poses of the last tick.
  virtual void apply(Tick& /*tick*/) {}

  /// After each substep of the physics, of kinds that follow substeps. Tick::state, rays and index
  /// are still those of the tick's start; Tick::physics reads the state of an entity.
  virtual void after_substep(Tick& /*tick*/) {}

  /// After physics, with rays and index at the new poses.
  virtual void sense(Tick& /*tick*/) {}

  /// Archives the state that the next tick reads beyond the world: charges, random streams.
  virtual void archive(math::Archive& /*archive*/) {}

  virtual bool follows_substeps() const { return false; }
  virtual bool casts_rays() const { return false; }   ///< then Tick::rays has the current poses
  virtual bool needs_index() const { return false; }  ///< likewise Tick::index
};

}  // namespace ziggurat::devices
