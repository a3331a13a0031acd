// SPDX-License-Identifier: MIT
#pragma once
// All devices of the world. docs/adding-a-device.md tells how to add a kind.

#include <memory>
#include <vector>

#include "devices/kind.h"

namespace ziggurat::devices {

/// All kinds, in the order in which they act and sense.
class Devices {
 public:
  /// Without devices: they come with lay_out() and add().
  Devices();
  Devices(const Devices& other);
  Devices(Devices&&) noexcept = default;
  Devices& operator=(Devices&&) noexcept = default;

  // Each calls the function of the same name of all kinds.
  void lay_out(const Carrier& carrier, world::RobotLayout& robot, world::Layout& layout) const;
  void add(const Setting& setting);
  void start(Tick& tick);
  void apply(Tick& tick);
  void after_substep(Tick& tick);
  void sense(Tick& tick);
  void archive(math::Archive& archive);
  bool casts_rays() const;
  bool needs_index() const;

 private:
  void list_substep_kinds();

  std::vector<std::unique_ptr<Kind>> kinds_;
  std::vector<Kind*> substep_kinds_;  ///< of them those that follow substeps
};

}  // namespace ziggurat::devices
