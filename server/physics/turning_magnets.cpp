// SPDX-License-Identifier: MIT
#include "physics/collision/shape.h"
#include "physics/magnet_source.h"

namespace ziggurat::physics {
namespace {

using math::Vector3;

constexpr double rounding = 1e-9;  // [m]

bool at_centre(const LinkBody& link, const Vector3& offset) {
  return (offset - link.center.position).norm() < rounding;
}

bool has_centred_magnet(const scene::Entity& entity, std::size_t link, const LinkBody& body) {
  bool found = false;
  for (const scene::Magnet& magnet : entity.devices.magnets) {
    if (magnet.anchor.link != static_cast<int>(link)) continue;
    if (!at_centre(body, magnet.offset)) return false;
    found = true;
  }
  return found;
}

bool is_leaf(const scene::Entity& entity, std::size_t link) {
  for (const scene::Joint& joint : entity.joints) {
    if (joint.parent == link) return false;
  }
  return true;
}

/// Mass and inertia of a carrier with what it carries, about its centre and axes.
struct Load {
  double mass;
  Vector3 moment = Vector3::Zero();  // first moment [kg m]
  Eigen::Matrix3d inertia;

  explicit Load(const LinkBody& carrier)
      : mass(carrier.mass), inertia(carrier.inertia.asDiagonal()) {}

  void add(double point_mass, const Vector3& at) {
    mass += point_mass;
    moment += point_mass * at;
    inertia += point_mass * (at.squaredNorm() * Eigen::Matrix3d::Identity() - at * at.transpose());
  }
  bool balanced() const {
    const Vector3 diagonal = inertia.diagonal();
    const Eigen::Matrix3d rest = inertia - Eigen::Matrix3d(diagonal.asDiagonal());
    return moment.norm() < rounding * mass && rest.norm() < 1e-9 * diagonal.norm();
  }
};

}  // namespace

void carry_turning_magnets(std::vector<LinkBody>& links, const scene::Entity& entity,
                           const std::vector<math::Pose>& assembled) {
  std::vector<std::vector<std::size_t>> carried(links.size());
  for (const scene::Joint& joint : entity.joints) {
    const scene::Link& link = entity.links[joint.child];
    const auto* sphere = std::get_if<scene::Sphere>(&link.geometry);
    if (joint.type != scene::JointType::spherical || !sphere || !is_leaf(entity, joint.child))
      continue;
    LinkBody& child = links[joint.child];
    if (!at_centre(child, joint.child_frame.position)) continue;
    if (!has_centred_magnet(entity, joint.child, child)) continue;
    const Vector3 center = math::inverse(links[joint.parent].center) * joint.parent_frame.position;
    if (depth(entity.links[joint.parent].geometry, center) >= sphere->radius - rounding) {
      carried[joint.parent].push_back(joint.child);
    }
  }
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (carried[i].empty()) continue;
    LinkBody& carrier = links[i];
    const math::Pose carrier_center = assembled[i] * carrier.center;
    Load load(carrier);
    for (const std::size_t child : carried[i]) {
      const math::Pose center = assembled[child] * links[child].center;
      load.add(links[child].mass, math::inverse(carrier_center) * center.position);
    }
    if (!load.balanced()) continue;
    carrier.mass = load.mass;
    carrier.inertia = load.inertia.diagonal();
    for (const std::size_t index : carried[i]) {
      LinkBody& child = links[index];
      child.carrier = static_cast<int>(i);
      child.mass = 0;
      child.inertia.setZero();
    }
  }
}

bool turns_freely(const LinkBody& link, const scene::Magnet& magnet) {
  return link.carrier != LinkBody::carries_itself && at_centre(link, magnet.offset);
}

}  // namespace ziggurat::physics
