// SPDX-License-Identifier: MIT
#include "supervision/moves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "simulation/joints.h"
#include "wire/messages.h"

namespace ziggurat::supervision {

using wire::ErrorCode;

std::variant<math::Pose, wire::Fault> pose_of(const math::Pose& now, const wire::Request& request) {
  const std::string name = request.kind == wire::Request::Kind::move ? "move" : "is_free";
  constexpr double farthest = 1e6;  // [m], as in scenes
  const auto is_near = [](double value) { return std::abs(value) <= farthest; };
  if (request.position.size() != 3 || !std::ranges::all_of(request.position, is_near)) {
    return wire::make_fault(ErrorCode::bad_value, name + ".position",
                            "A position must be three numbers x, y, z from -1e6 to 1e6 metres.");
  }
  math::Pose pose = now;
  pose.position = {request.position[0], request.position[1], request.position[2]};
  if (request.orientation.empty()) return pose;
  const auto& q = request.orientation;
  const double norm = std::sqrt(std::inner_product(q.begin(), q.end(), q.begin(), 0.0));
  if (q.size() != 4 || !std::isfinite(norm) || norm < 1e-6) {
    return wire::make_fault(ErrorCode::bad_value, name + ".orientation",
                            "An orientation must be a quaternion w, x, y, z, finite and not zero.");
  }
  pose.orientation = math::Quaternion(q[0], q[1], q[2], q[3]).normalized();
  return pose;
}

namespace {

simulation::JointMotion motion_of(const wire::Request& request) {
  return {request.joint, request.joint_position, request.joint_velocity};
}

}  // namespace

std::optional<wire::Fault> check_joint(const simulation::Simulation& world, std::size_t entity,
                                       const wire::Request& request) {
  using Of = simulation::JointFault::Of;
  const auto fault = simulation::fault_of(world, entity, motion_of(request));
  if (!fault) return std::nullopt;
  switch (fault->of) {
    case Of::joint:
      return wire::make_fault(ErrorCode::unknown_entity, "set_joint.joint", fault->text);
    case Of::position:
      return wire::make_fault(ErrorCode::bad_value, "set_joint.position", fault->text);
    case Of::velocity:
      break;
  }
  return wire::make_fault(ErrorCode::bad_value, "set_joint.velocity", fault->text);
}

namespace {

std::optional<wire::Fault> set_joint(simulation::Simulation& world, const Callers& callers,
                                     std::size_t entity, const wire::Request& request) {
  if (auto fault = check_joint(world, entity, request)) return fault;
  simulation::set_joint(world, entity, motion_of(request));
  callers.tell(
      JointSet{request.text, request.joint, request.joint_position, request.joint_velocity});
  return std::nullopt;
}

}  // namespace

std::optional<wire::Fault> move(simulation::Simulation& world, const Callers& callers,
                                std::size_t entity, const wire::Request& request) {
  if (request.kind == wire::Request::Kind::set_joint)
    return set_joint(world, callers, entity, request);
  auto pose = pose_of(world.state().origins[entity], request);
  if (auto* fault = std::get_if<wire::Fault>(&pose)) return std::move(*fault);
  const math::Pose& to = std::get<math::Pose>(pose);
  if (!request.may_overlap) {
    if (const auto other = simulation::overlapped_by(world, world.entities()[entity], to, entity)) {
      return wire::make_fault(
          ErrorCode::bad_value, "move.position",
          fmt::format("'{}' overlaps '{}' where it is moved to; choose a place that is free, or "
                      "say that it may overlap.",
                      request.text, world.layout().entities[*other].id));
    }
  }
  world.move(entity, to);
  callers.tell(Moved{request.text, to});
  return std::nullopt;
}

}  // namespace ziggurat::supervision
