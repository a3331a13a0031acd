// SPDX-License-Identifier: MIT
#include "simulation/joints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "simulation/parts.h"

namespace ziggurat::simulation {
namespace {

constexpr double most = 1e6;  // [m], [rad], [m/s], [rad/s]

std::string list_of(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "'" : ", '") + name + "'";
  return list;
}

/// The fault of an id that no revolute or prismatic joint has.
std::string text_of_unknown(const scene::Entity& entity, const std::string& id) {
  constexpr std::size_t longest = 64, most_named = 16;
  std::vector<std::string> names;
  for (const scene::Joint& joint : entity.joints) {
    if (joint.id == id)
      return fmt::format(
          "Joint '{}' of '{}' is not revolute or prismatic: it has no position to set.", id,
          entity.id);
    if (scene::has_coordinate(joint.type) && names.size() < most_named) names.push_back(joint.id);
  }
  return fmt::format("'{}' has no joint '{}'; {}.", entity.id, id.substr(0, longest),
                     names.empty() ? "it has none that is revolute or prismatic"
                                   : "write one of " + list_of(names));
}

}  // namespace

std::optional<JointFault> fault_of(const Simulation& world, std::size_t entity,
                                   const JointMotion& wanted) {
  using Of = JointFault::Of;
  const scene::Entity& of = world.entities()[entity];
  const auto joint = std::ranges::find(of.joints, wanted.joint, &scene::Joint::id);
  if (joint == of.joints.end() || !scene::has_coordinate(joint->type)) {
    return JointFault{Of::joint, text_of_unknown(of, wanted.joint)};
  }
  const scene::JointLimit range = joint->limit.value_or(scene::JointLimit{-most, most});
  const char* unit = joint->type == scene::JointType::revolute ? "rad" : "m";
  if (!(wanted.position >= range.lower && wanted.position <= range.upper)) {
    return JointFault{
        Of::position,
        fmt::format(
            "The position of joint '{}' of '{}' is {:.6g}; it must be from {:.6g} to {:.6g} {}.",
            joint->id, of.id, wanted.position, range.lower, range.upper, unit)};
  }
  if (!(std::abs(wanted.velocity) <= most)) {
    return JointFault{
        Of::velocity,
        fmt::format(
            "The velocity of joint '{}' of '{}' is {:.6g}; it must be from -1e6 to 1e6 {}/s.",
            joint->id, of.id, wanted.velocity, unit)};
  }
  return std::nullopt;
}

void set_joint(Simulation& to, std::size_t entity, const JointMotion& wanted) {
  Parts& parts = to.parts();
  const auto& joints = parts.entities[entity].joints;
  const auto joint = std::ranges::find(joints, wanted.joint, &scene::Joint::id);
  const physics::JointIndex index =
      parts.physics.joint(entity, static_cast<std::size_t>(joint - joints.begin()));
  set_joint(parts.physics, entity, index, wanted.position, wanted.velocity);
  parts.physics.read(entity, parts.state);
  parts.looks_are_old = true;
}

}  // namespace ziggurat::simulation
