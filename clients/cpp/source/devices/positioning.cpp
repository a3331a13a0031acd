// SPDX-License-Identifier: MIT
#include "layout.h"

namespace ziggurat {

void Layout::add_positioning() {
  auto& readings = add(Readings<Positioning>("numbers of poses", &v1::Observation::positioning));
  each_robot([&](const v1::RobotDescription& from, Robot& to) {
    if (from.positioning()) readings.add(to.positioning_.emplace());
  });
}

}  // namespace ziggurat
