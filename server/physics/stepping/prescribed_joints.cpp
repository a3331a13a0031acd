// SPDX-License-Identifier: MIT
#include "physics/stepping/unconstrained_trees.h"

namespace ziggurat::dynamics {

void find_prescribed_joints(const Problem& problem, std::span<const Servo> servos,
                            IslandPrescribedJoints& out) {
  const std::size_t dofs = problem.velocity.size();
  out.has_servos.assign(problem.trees.size(), 0);
  out.prescribed.assign(dofs, 0);
  out.velocity.assign(dofs, 0.0);
  out.force.assign(dofs, 0.0);
  for (const Constraint& constraint : problem.constraints) {
    if (constraint.kind != Constraint::Kind::servo) continue;
    const Servo& servo = servos[constraint.source];
    if (servo.dof < 0) continue;
    const std::size_t at = problem.offset[constraint.a] + servo.dof;
    out.has_servos[constraint.a] = 1;
    out.prescribed[at] = is_unsaturated(servo);
    out.velocity[at] = servo.target_velocity;
    out.force[at] = servo.impulse / problem.time_step;
  }
}

PrescribedJoints prescribed_joints_of(const Problem& problem, std::size_t tree,
                                      const IslandPrescribedJoints& drives) {
  if (!drives.has_servos[tree]) return {};
  const auto of_tree = [&](const auto& all) {
    return std::span(all).subspan(problem.offset[tree], problem.trees[tree]->dofs);
  };
  return {of_tree(drives.prescribed), of_tree(drives.velocity), of_tree(drives.force)};
}

}  // namespace ziggurat::dynamics
