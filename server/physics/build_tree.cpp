// SPDX-License-Identifier: MIT
#include "physics/bodies/convert.h"
#include "physics/build.h"

namespace ziggurat::physics {
namespace {

dynamics::JointType type_of(scene::JointType type) {
  switch (type) {
    case scene::JointType::spherical:
      return dynamics::JointType::spherical;
    case scene::JointType::prismatic:
      return dynamics::JointType::prismatic;
    default:
      return dynamics::JointType::revolute;
  }
}

void join(dynamics::Link& link, const Body& body, const scene::Joint& joint) {
  const LinkBody& parent = body.links[joint.parent];
  const LinkBody& child = body.links[joint.child];
  link.parent = static_cast<int>(parent.part);
  link.joint = type_of(joint.type);
  link.joint_in_parent = parent.frame_in_part() * joint.parent_frame;
  link.joint_in_link = child.frame_in_part() * joint.child_frame;
  link.axis = joint.child_frame.orientation.conjugate() * joint.axis;
}

/// Freedoms of a root: wheels keep a body upright, and a plane at its height.
unsigned freedoms_of(const Body& body, const scene::Entity& entity, const scene::Physics& physics) {
  if (!body.ground) return dynamics::all_freedoms;
  return plane_of(entity, physics) ? dynamics::planar_freedoms : dynamics::upright_freedoms;
}

}  // namespace

dynamics::Tree make_tree(const Body& body, const scene::Entity& entity,
                         const scene::Physics& physics) {
  std::vector<dynamics::Link> links(body.parts.size());
  for (std::size_t i = 0; i < links.size(); ++i) {
    links[i].mass = body.parts[i].mass;
    links[i].inertia = body.parts[i].inertia;
  }
  links[0].joint = entity.movable ? dynamics::JointType::floating : dynamics::JointType::fixed;
  for (const scene::Joint& joint : entity.joints) {
    const std::size_t part = body.links[joint.child].part;
    if (part != body.links[joint.parent].part) join(links[part], body, joint);
  }
  dynamics::Tree tree(std::move(links), base_pose(body), freedoms_of(body, entity, physics));
  // Rotors of a flying body balance it all the time (physics/flight.h).
  if (!body.flight) tree.gravity.z() = -physics.gravity.value_or(0);
  return tree;
}

}  // namespace ziggurat::physics
