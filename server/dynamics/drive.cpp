#include "dynamics/drive.h"

#include "dynamics/flight.h"

namespace ziggurat::dynamics {

void fly_driven(const Problem& problem, std::span<const Servo> servos, Workspace& work, Drives& memory) {
  const std::size_t dofs = problem.velocity.size();
  memory.driven.assign(problem.trees.size(), 0);
  memory.held.assign(dofs, 0);
  memory.speed.assign(dofs, 0.0);
  memory.push.assign(dofs, 0.0);
  for (const Block& block : problem.blocks) {
    if (block.kind != Block::Source::servo) continue;
    const Servo& servo = servos[block.source];
    if (servo.dof < 0) continue;
    const std::size_t at = problem.offset[block.a] + servo.dof;
    memory.driven[block.a] = 1;
    memory.held[at] = is_obeyed(servo);
    memory.speed[at] = servo.speed;
    memory.push[at] = servo.impulse / problem.length;
  }
  for (std::size_t i = 0; i < problem.trees.size(); ++i) {
    Tree& tree = *problem.trees[i];
    const auto of_tree = [&](auto& all) { return std::span(all).subspan(problem.offset[i], tree.dofs); };
    const Drive drive = memory.driven[i] ? Drive{of_tree(memory.held), of_tree(memory.speed), of_tree(memory.push)} : Drive{};
    fly(tree, work, problem.length, drive);
  }
}

}  // namespace ziggurat::dynamics
