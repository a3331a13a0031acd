// SPDX-License-Identifier: MIT
#include "layout.h"

namespace ziggurat {

void Layout::add_batteries() {
  auto& readings = add(Readings<Battery>("numbers of batteries", &v1::Observation::batteries));
  each_robot([&](const v1::RobotDescription& from, Robot& to) {
    if (from.battery()) readings.add(to.battery_.emplace());
  });
}

}  // namespace ziggurat
