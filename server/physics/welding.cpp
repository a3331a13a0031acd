// SPDX-License-Identifier: MIT
#include "physics/welding.h"

#include "math/pose.h"

namespace ziggurat::physics {
namespace {

using Eigen::Matrix3d;
using math::Pose;
using math::Vector3;

/// X_ES of a shape's centre.
Pose centre(const LinkBody& link, const Pose& assembled) { return assembled * link.center; }

/// The links of each part.
std::vector<std::vector<LinkBody*>> by_part(std::vector<LinkBody>& links, std::size_t parts) {
  std::vector<std::vector<LinkBody*>> found(parts);
  for (LinkBody& link : links) found[link.part].push_back(&link);
  return found;
}

Matrix3d inertia_about(const Vector3& point, const std::vector<LinkBody*>& links) {
  Matrix3d sum = Matrix3d::Zero();
  for (const LinkBody* link : links) {
    const Matrix3d axes = link->in_part.orientation.toRotationMatrix();
    const Vector3 arm = link->in_part.position - point;
    sum += axes * link->inertia.asDiagonal() * axes.transpose();
    sum += link->mass * (arm.squaredNorm() * Matrix3d::Identity() - arm * arm.transpose());
  }
  return sum;
}

/// Moves a part's frame from its first link's centre to where all its links balance.
void balance(Part& part, const std::vector<LinkBody*>& links) {
  part.mass = 0;
  Vector3 moment = Vector3::Zero();
  for (const LinkBody* link : links) {
    part.mass += link->mass;
    moment += link->mass * link->in_part.position;
  }
  const Vector3 centre_of_mass = moment / part.mass;
  const Matrix3d inertia = inertia_about(centre_of_mass, links);
  const math::Quaternion axes = math::principal_axes(inertia);
  const Matrix3d rotation = axes.toRotationMatrix();
  part.inertia = (rotation.transpose() * inertia * rotation).diagonal();
  const Pose into = math::inverse({centre_of_mass, axes});
  for (LinkBody* link : links) link->in_part = into * link->in_part;
}

}  // namespace

std::vector<Part> weld(std::vector<LinkBody>& links, const scene::Entity& entity,
                       const std::vector<Pose>& assembled) {
  std::vector<Part> parts;
  std::vector<std::size_t> first;  // link of each part
  const auto begin = [&](std::size_t link) {
    Part part;
    part.moves = links[link].moves;
    part.mass = links[link].mass;
    part.inertia = links[link].inertia;
    links[link].part = parts.size();
    parts.push_back(part);
    first.push_back(link);
  };
  begin(entity.reference_link);
  for (const scene::Joint& joint : entity.joints) {  // from the root outwards
    LinkBody& child = links[joint.child];
    if (joint.type != scene::JointType::fixed && child.carrier == LinkBody::carries_itself) {
      begin(joint.child);
      continue;
    }
    child.part = links[joint.parent].part;
    child.moves = parts[child.part].moves;
    const std::size_t root = first[child.part];
    child.in_part =
        math::inverse(centre(links[root], assembled[root])) * centre(child, assembled[joint.child]);
  }
  const auto welded = by_part(links, parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].moves && welded[i].size() > 1) balance(parts[i], welded[i]);
  }
  return parts;
}

}  // namespace ziggurat::physics
