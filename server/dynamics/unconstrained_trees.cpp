#include "dynamics/unconstrained_trees.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ziggurat::dynamics {
namespace {

/// How fast a contact pushes out what is pressed in, without what it asks for because its surfaces turn [m/s].
double speed_out(const Problem& problem, const Block& block) { return block.seek[0] - problem.length / 2 * std::max(0.0, -block.bend); }

/// Whether it may do no more than that.
bool may_only_push_out(const Problem& problem, const Block& block) {
  const double out = speed_out(problem, block);
  return block.yield > 0 && out > 0 && std::abs(block.impulse[0]) * block.mobility[0] <= 2 * out;
}

/// Whether a block does more, or a joint is beyond its limit, as a scene may begin.
bool holds(const Problem& problem, const Block& block) {
  return (block.impulse[0] != 0 && !may_only_push_out(problem, block)) ||
         (block.kind == Block::Source::limit && block.gap < -problem.allowed_overlap);
}

/// Whether bodies would pass through a surface on the way that gravity bends, though their speed at its end does not say so:
/// what a push nearly carries.
bool is_crossed(const Problem& problem, const Block& block) {
  if (block.kind != Block::Source::contact) return false;
  const auto fall = [&](int place) -> Vector3 {
    if (place < 0 || !problem.trees[place]->free_root) return Vector3::Zero();
    return problem.trees[place]->gravity;
  };
  const double pull = block.frame.col(0).dot(fall(block.a) - fall(block.b));
  if (pull <= 0) return false;  // as for all that lies on something
  double u[Block::most_rows];
  problem.speeds(block, u);
  return block.gap + problem.length * (u[0] - problem.length / 2 * pull) < -problem.allowed_overlap;
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
  return u[0] < -slow * speed_out(problem, block);
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
    if (!is_motor && (holds(problem, block) || is_crossed(problem, block))) touch(block);
  }
  memory.velocity.resize(problem.velocity.size());
  memory.is_known.assign(problem.trees.size(), 0);
  for (const Block& block : problem.blocks) {
    if (count == 0) return 0;
    const auto is_free = [&](int tree) { return tree >= 0 && out[tree]; };
    if (block.impulse[0] == 0 || !may_only_push_out(problem, block) || !(is_free(block.a) || is_free(block.b))) continue;
    if (would_close(problem, block, work, memory)) touch(block);
  }
  for (std::size_t before = count + 1; 0 < count && count < before;) {  // what one of two gets the other one gets, too
    before = count;
    for (const Block& block : problem.blocks) {
      if (block.impulse[0] != 0 && block.a >= 0 && block.b >= 0 && out[block.a] != out[block.b]) touch(block);
    }
  }
  return count;
}

void take_back_pushes(Problem& problem, std::span<const unsigned char> free) {
  const auto stays = [&](int tree) { return tree >= 0 && !free[tree]; };
  for (Block& block : problem.blocks) {
    if (block.kind == Block::Source::contact && !stays(block.a) && !stays(block.b)) block.impulse.fill(0);
  }
}

}  // namespace ziggurat::dynamics
