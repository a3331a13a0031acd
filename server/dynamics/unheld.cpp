#include "dynamics/unheld.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ziggurat::dynamics {
namespace {

/// Whether a contact may do no more than push out what is pressed in.
bool may_only_push_out(const Block& block) {
  return block.yield > 0 && block.seek[0] > 0 && std::abs(block.impulse[0]) * block.mobility[0] <= 2 * block.seek[0];
}

/// Whether a block does more, or a joint is beyond its limit, as a scene may begin.
bool holds(const Block& block, double allowed) {
  return (block.impulse[0] != 0 && !may_only_push_out(block)) || (block.kind == Block::Source::limit && block.gap < -allowed);
}

/// Whether bodies would pass through a surface on the way that gravity bends, though their speed at its end does not say so:
/// what a push nearly carries.
bool is_crossed(const Problem& problem, const Block& block, double allowed) {
  if (block.kind != Block::Source::contact) return false;
  const auto fall = [&](int place) -> Vector3 {
    if (place < 0 || !problem.trees[place]->free_root) return Vector3::Zero();
    return problem.trees[place]->gravity;
  };
  const double pull = block.frame.col(0).dot(fall(block.a) - fall(block.b));
  if (pull <= 0) return false;  // as for all that lies on something
  double u[Block::most_rows];
  problem.speeds(block, u);
  return block.gap + problem.length * (u[0] - problem.length / 2 * pull) < -allowed;
}

/// Finds the velocity of a tree that nothing touches.
void find_velocity(const Problem& problem, int place, Workspace& work, FreeVelocities& out) {
  if (place < 0 || std::exchange(out.is_known[place], 1)) return;
  const Tree& tree = *problem.trees[place];
  compute_mass(tree, work);
  factor_mass(tree, work, problem.length);
  double* velocity = out.velocity.data() + problem.offset[place];
  std::copy_n(problem.momentum.data() + problem.offset[place], tree.dofs, velocity);
  solve_mass(tree, work, velocity);
}

/// Whether surfaces that are pressed together would come closer without the contact. What it gives says little: of many contacts each
/// gives a part of what holds.
bool would_close(const Problem& problem, const Block& block, Workspace& work, FreeVelocities& memory) {
  constexpr double slow = 1e-3;  // of the speed that it is pushed out with
  find_velocity(problem, block.a, work, memory);
  find_velocity(problem, block.b, work, memory);
  double u[Block::most_rows];
  problem.speeds(block, u, memory.velocity.data());
  return u[0] < -slow * block.seek[0];
}

}  // namespace

std::size_t find_free(const Problem& problem, std::span<const Servo> servos, Workspace& work, FreeVelocities& memory,
                      std::vector<unsigned char>& out) {
  std::size_t count = problem.trees.size();
  out.assign(count, 1);
  const auto touch = [&](const Block& block) {
    for (const int tree : {block.a, block.b}) count -= tree >= 0 && std::exchange(out[tree], 0);
  };
  for (const Block& block : problem.blocks) {
    if (count == 0) return 0;
    const bool is_motor = block.kind == Block::Source::servo && servos[block.source].dof >= 0;
    if (!is_motor && (holds(block, problem.allowed_overlap) || is_crossed(problem, block, problem.allowed_overlap))) touch(block);
  }
  memory.velocity.resize(problem.velocity.size());
  memory.is_known.assign(problem.trees.size(), 0);
  for (const Block& block : problem.blocks) {
    if (count == 0) return 0;
    const auto is_free = [&](int tree) { return tree >= 0 && out[tree]; };
    if (block.impulse[0] == 0 || !may_only_push_out(block) || !(is_free(block.a) || is_free(block.b))) continue;
    if (would_close(problem, block, work, memory)) touch(block);
  }
  return count;
}

}  // namespace ziggurat::dynamics
