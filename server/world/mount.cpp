// SPDX-License-Identifier: MIT
#include "world/state.h"

namespace ziggurat::world {
namespace {

const math::Pose& anchor_of(const State& state, const Mount& mount) {
  return mount.link ? state.links[*mount.link].pose : state.origins[mount.entity];
}

}  // namespace

math::Pose pose_of(const State& state, const Mount& mount) {
  return anchor_of(state, mount) * mount.pose;
}

math::Vector3 position_of(const State& state, const Mount& mount) {
  return anchor_of(state, mount) * mount.pose.position;
}

}  // namespace ziggurat::world
