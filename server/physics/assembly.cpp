#include "physics/assembly.h"

namespace ziggurat::physics {

using math::Pose;
using math::Vector3;

std::vector<Pose> assemble(const scene::Entity& entity) {
  std::vector<Pose> poses;
  for (const scene::Link& link : entity.links) poses.push_back(link.offset);  // frames stay there
  for (const scene::Joint& joint : entity.joints) {  // from the root outwards
    poses[joint.child] =
        poses[joint.parent] * joint.parent_frame * math::inverse(joint.child_frame);
  }
  return poses;
}

Vector3 center_of_mass(const scene::Geometry& geometry) {
  if (const auto* box = std::get_if<scene::Box>(&geometry)) return {0, 0, box->size.z() / 2};
  if (const auto* cylinder = std::get_if<scene::Cylinder>(&geometry)) {
    return {0, 0, cylinder->height / 2};
  }
  return {0, 0, std::get<scene::Sphere>(geometry).radius};
}

Vector3 inertia(const scene::Geometry& geometry, double mass) {
  if (const auto* box = std::get_if<scene::Box>(&geometry)) {
    const Vector3 squares = box->size.cwiseAbs2();
    return mass / 12 *
           Vector3(squares.y() + squares.z(), squares.x() + squares.z(), squares.x() + squares.y());
  }
  if (const auto* cylinder = std::get_if<scene::Cylinder>(&geometry)) {
    const double r2 = cylinder->radius * cylinder->radius;
    const double side = mass * (3 * r2 + cylinder->height * cylinder->height) / 12;
    return {side, side, mass * r2 / 2};
  }
  const double radius = std::get<scene::Sphere>(geometry).radius;
  return Vector3::Constant(0.4 * mass * radius * radius);
}

}  // namespace ziggurat::physics
