// SPDX-License-Identifier: MIT
#include "physics/bodies/bodies.h"

namespace ziggurat::physics {

using math::Pose;

std::vector<Pose> assemble(const scene::Entity& entity) {
  std::vector<Pose> poses;
  for (const scene::Link& link : entity.links) poses.push_back(link.offset);  // frames stay there
  for (const scene::Joint& joint : entity.joints) {  // from the root outwards
    poses[joint.child] =
        poses[joint.parent] * joint.parent_frame * math::inverse(joint.child_frame);
  }
  return poses;
}

}  // namespace ziggurat::physics
