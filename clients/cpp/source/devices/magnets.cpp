// SPDX-License-Identifier: MIT
#include "layout.h"

namespace ziggurat {

void Layout::add_magnets() {
  auto& currents = add(Settings<double>(&v1::Command::mutable_magnet_currents));
  each_robot([&](const v1::RobotDescription& robot, Robot& to) {
    for (const v1::MagnetDescription& from : robot.magnets()) {
      Magnet& magnet = to.magnets_.emplace_back();
      magnet.id_ = from.id();
      magnet.current_ = &currents.add(0.0);
      magnet.changed_ = &currents.changed();
    }
  });
}

void Magnet::set_current(double current) {
  check_finite(current, "the current of magnet", id_);
  *current_ = current;
  *changed_ = true;
}

}  // namespace ziggurat
