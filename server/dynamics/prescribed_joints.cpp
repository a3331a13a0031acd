#include "dynamics/prescribed_joints.h"

namespace ziggurat::dynamics {

void find_drives(const Problem& problem, std::span<const Servo> servos, Drives& out) {
  const std::size_t dofs = problem.velocity.size();
  out.driven.assign(problem.trees.size(), 0);
  out.held.assign(dofs, 0);
  out.speed.assign(dofs, 0.0);
  out.push.assign(dofs, 0.0);
  for (const Block& block : problem.blocks) {
    if (block.kind != Block::Source::servo) continue;
    const Servo& servo = servos[block.source];
    if (servo.dof < 0) continue;
    const std::size_t at = problem.offset[block.a] + servo.dof;
    out.driven[block.a] = 1;
    out.held[at] = is_obeyed(servo);
    out.speed[at] = servo.speed;
    out.push[at] = servo.impulse / problem.length;
  }
}

Drive drive_of(const Problem& problem, std::size_t tree, const Drives& drives) {
  if (!drives.driven[tree]) return {};
  const auto of_tree = [&](const auto& all) { return std::span(all).subspan(problem.offset[tree], problem.trees[tree]->dofs); };
  return {of_tree(drives.held), of_tree(drives.speed), of_tree(drives.push)};
}

}  // namespace ziggurat::dynamics
