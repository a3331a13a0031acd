#include "dynamics/restitution_timing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "dynamics/constraint.h"
#include "dynamics/sequential_impacts.h"

namespace ziggurat::dynamics {
namespace {

/// Larger islands are not looked at for what they do not come to meet.
constexpr std::size_t most_blocks = 300;

/// Whether a side of a contact is a larger tree than responses are worked out for.
bool is_large(const Problem& problem, const Block& block) {
  return std::ranges::any_of(std::array{block.a, block.b}, [&](int place) { return place >= 0 && problem.trees[place]->dofs > most_dofs_struck; });
}

/// Whether a contact held what is on it in the last substep, and does not part.
bool may_carry(const Problem& problem, const Block& block) {
  constexpr double resting = 1e-3;  // what parts faster does not carry any more [m/s]
  if (block.kind != Block::Source::contact || block.impulse[0] == 0 || block.gap > problem.allowed_overlap) return false;
  double u[Block::most_rows];
  problem.speeds(block, u);
  return u[0] <= resting;
}

/// Notes which trees what touches them from below carries, and what contacts gave them in the last substep.
void find_carried(Problem& problem) {
  problem.carried.assign(problem.trees.size(), 0.0);
  problem.pressed.assign(problem.trees.size(), Vector3::Zero());
  for (const Block& block : problem.blocks) {
    if (block.kind != Block::Source::contact) continue;
    Vector3 push = Vector3::Zero();
    for (int r = 0; r < std::min(block.rows, 3); ++r) push += block.impulse[r] * block.frame.col(r);
    if (block.a >= 0) problem.pressed[block.a] += push;
    if (block.b >= 0) problem.pressed[block.b] -= push;
    if (!may_carry(problem, block)) continue;
    if (block.a >= 0) problem.carried[block.a] -= push.dot(problem.trees[block.a]->gravity);
    if (block.b >= 0) problem.carried[block.b] += push.dot(problem.trees[block.b]->gravity);
  }
}

/// What a tree falls with [m/s^2].
Vector3 fall_of(const Problem& problem, int place) {
  if (place < 0 || !problem.trees[place]->free_root) return Vector3::Zero();
  const Vector3& gravity = problem.trees[place]->gravity;
  const double all = problem.length * problem.total_mass[place] * gravity.squaredNorm();
  return problem.carried[place] > all / 2 ? Vector3(Vector3::Zero()) : gravity;
}

/// What free fall accelerates the surfaces of a contact apart by [m/s^2].
double pull_of(const Problem& problem, const Block& block) {
  return block.frame.col(0).dot(fall_of(problem, block.a) - fall_of(problem, block.b));
}

/// What pushes give a tree along a direction at the substep's beginning, without what contacts held of it in the last one [m/s].
double push_of(const Problem& problem, int place, const Vector3& along) {
  if (place < 0 || !problem.trees[place]->free_root) return 0;
  double push = 0;
  for (const Wrench& wrench : problem.trees[place]->external) push += problem.length * wrench.force.dot(along);
  const double held = problem.pressed[place].dot(along), left = push * held < 0 ? push + held : push;
  return left * push > 0 ? left / problem.total_mass[place] : 0;
}

/// By how much pushes let the surfaces of a contact part faster at the substep's beginning [m/s].
double kick_of(const Problem& problem, const Block& block) {
  const Vector3 normal = block.frame.col(0);
  return push_of(problem, block.a, normal) - push_of(problem, block.b, normal);
}

/// How fast the surfaces of a contact part at the substep's beginning, without that [m/s].
double parting_of(const Problem& problem, const Block& block) {
  double u[Block::most_rows];
  problem.speeds(block, u);
  return u[0];
}

/// When in the substep surfaces meet, and with which speed and how far apart they are at its end.
/// @param before  how fast they part at its beginning [m/s];  @param pull  and by how much faster in a second [m/s^2]
/// @return        whether they do
bool aim(const Problem& problem, Block& block, double before, double pull) {
  const double gap = std::max(0.0, block.gap);
  const double square = before * before - 2 * pull * gap;  // of the speed of the impact
  if (square < slow_impact * slow_impact) return false;
  const double impact = std::sqrt(square);
  if (impact <= before) return false;  // they part
  const double time = 2 * gap / (impact - before), rest = problem.length - time;
  if (rest <= 0) {  // not yet: nothing may hold it
    block.seek[0] = std::min(block.seek[0], before + problem.length * pull);
    return false;
  }
  const double rise = rest * (block.restitution * impact + rest * pull / 2);
  if (rise <= 0) return false;
  block.bounces = true;
  block.yield = 0;
  block.met = time;
  block.rise = rise;
  block.before = -impact - rest * pull;
  block.seek[0] = block.restitution * impact + rest * pull;
  return true;
}

/// A push that is small beside the speed acts throughout, as gravity does; a larger one throws at the substep's beginning. What
/// touches already is pressed by it.
void aim(const Problem& problem, Block& block) {
  const double before = parting_of(problem, block), pull = pull_of(problem, block);
  const double kick = block.gap > touching ? kick_of(problem, block) : 0;
  if (kick != 0 && std::abs(kick) < -before && aim(problem, block, before, pull + kick / problem.length)) return;
  aim(problem, block, before + kick, pull);
}

/// Whether a contact is still met when another one, which is met earlier, has rebounded: a ball on a plate does not reach the
/// floor below that.
bool is_met_after(const Problem& problem, const Block& later, const Block& earlier) {
  if (is_large(problem, earlier)) return true;
  const double own = response(problem, earlier, earlier), cross = response(problem, earlier, later);
  if (!(own > 0) || cross <= 0) return true;
  double now[Block::most_rows], impact[Block::most_rows];
  problem.speeds(later, now);
  problem.speeds(earlier, impact);
  const double change = cross / own * (earlier.seek[0] - impact[0]);
  return later.gap + earlier.met * now[0] + (problem.length - earlier.met) * (now[0] + change) < 0;
}

/// Whether a contact holds something up: what strikes that strikes all that is below it, too.
bool holds_up(const Problem& problem, const Block& block) {
  constexpr double share = 0.01;  // of the weight
  if (!may_carry(problem, block)) return false;
  const auto is_on = [&](int place) {
    if (place < 0) return false;
    const Vector3& gravity = problem.trees[place]->gravity;
    const double weight = problem.length * problem.total_mass[place] * gravity.squaredNorm();
    return block.impulse[0] * std::abs(block.frame.col(0).dot(gravity)) > share * weight;
  };
  return is_on(block.a) || is_on(block.b);
}

/// Whether an impact pushes what another block holds.
bool disturbs(const Problem& problem, const Block& impact, const Block& held) {
  constexpr double slight = 1e-3;  // of what it does to itself
  const double cross = std::abs(response(problem, impact, held));
  return cross > (held.kind == Block::Source::contact ? slight * response(problem, impact, impact) : 0);
}

/// The impacts of an island whose bodies may strike each other in turn: single points of what nothing holds against them. None: it has
/// others, too, or hardly any.
std::vector<Impact> impacts_in_turn(Problem& problem) {
  constexpr std::size_t most = 32;
  std::vector<Impact> out;
  std::vector<const Block*> others;
  bool any = false;
  for (Block& block : problem.blocks) {
    const bool rebounds = block.kind == Block::Source::contact && block.restitution > 0;
    if (!rebounds || holds_up(problem, block)) {
      others.push_back(&block);
      continue;
    }
    const auto is_of_the_same_face = [&](const Impact& other) {
      return other.block->a == block.a && other.block->b == block.b && other.block->frame.col(0) == block.frame.col(0);
    };
    if (out.size() == most || std::ranges::any_of(out, is_of_the_same_face) || is_large(problem, block)) return {};
    out.push_back({&block, parting_of(problem, block) + kick_of(problem, block), pull_of(problem, block)});
    any |= block.gap + problem.length * (out.back().speed + problem.length * out.back().pull) < 0;
  }
  if (!any || out.size() < 2) return {};
  for (const Impact& impact : out) {
    if (std::ranges::any_of(others, [&](const Block* held) { return disturbs(problem, *impact.block, *held); })) return {};
  }
  return out;
}

/// Lets contacts with restitution seek the speeds with which they rebound, and end where they do.
void aim_rebounds(Problem& problem) {
  const auto rebounds = [](const Block& block) { return block.restitution > 0; };
  if (std::ranges::none_of(problem.blocks, rebounds)) return;
  find_carried(problem);
  const std::vector<Impact> impacts = impacts_in_turn(problem);
  if (!impacts.empty() && take_in_turn(problem, impacts)) return;
  for (Block& block : problem.blocks) {
    if (rebounds(block)) aim(problem, block);
  }
  if (problem.blocks.size() > most_blocks) return;
  for (Block& block : problem.blocks) {
    const auto hides_it = [&](const Block& other) {
      const auto shares = [&](int tree) { return tree >= 0 && (tree == block.a || tree == block.b); };
      const bool is_later = block.before * (other.met - block.met) > touching;  // flat faces are not so exactly flat
      return other.bounces && is_later && (shares(other.a) || shares(other.b)) && !is_met_after(problem, block, other);
    };
    if (!block.bounces || std::ranges::none_of(problem.blocks, hides_it)) continue;
    block.bounces = false;
    block.seek[0] = -block.gap / problem.length;
  }
}

/// Whether two contacts press a tree from opposite sides: it can't be where both would have it rebound to.
bool squeeze(const Block& one, const Block& other) {
  constexpr double opposite = -0.5;  // cosine of the angle between them
  const auto side = [](const Block& block, int tree) { return block.a == tree ? 1.0 : block.b == tree ? -1.0 : 0.0; };
  for (const int tree : {one.a, one.b}) {
    if (tree < 0) continue;
    if (side(one, tree) * side(other, tree) * one.frame.col(0).dot(other.frame.col(0)) < opposite) return true;
  }
  return false;
}

/// Whether a servo of a solved problem gives all that it has, or a limit holds: then what moves fast is not so for the whole substep.
bool is_strained(const Problem& problem) {
  return std::ranges::any_of(problem.blocks, [](const Block& block) {
    return (block.kind == Block::Source::servo && block.impulse[0] != 0 && !block.is_obeyed()) ||
           (block.kind == Block::Source::limit && block.impulse[0] > 0);
  });
}

/// Lets contacts with restitution that something sets in motion towards each other within the substep rebound, too: as from the speed
/// that they would have without each other, from the beginning on.
/// @param problem  solved
/// @return         whether it must be solved again
bool aim_what_is_thrown(Problem& problem, Solver& solver) {
  std::vector<Block*> thrown;
  for (Block& block : problem.blocks) {
    const bool rebounds = block.kind == Block::Source::contact && block.restitution > 0 && !block.bounces;
    if (!rebounds || block.impulse[0] == 0 || block.gap <= slow_impact * problem.length) continue;
    const auto squeezes = [&](const Block& other) { return other.bounces && squeeze(block, other); };
    if (std::ranges::none_of(problem.blocks, squeezes)) thrown.push_back(&block);
  }
  if (thrown.empty() || is_strained(problem)) return false;
  for (Block* block : thrown) {
    block->law = Block::Law::off;
    block->impulse.fill(0);
  }
  solver.solve(problem);
  const bool is_known = !is_strained(problem);
  for (Block* block : thrown) {
    block->law = Block::Law::contact;
    if (!is_known) continue;
    double u[Block::most_rows];
    problem.speeds(*block, u);
    const double time = u[0] < -slow_impact ? -block->gap / u[0] : HUGE_VAL, rest = problem.length - time;
    if (rest <= 0) continue;
    block->bounces = true;
    block->yield = 0;
    block->met = time;
    block->before = u[0];
    block->seek[0] = -block->restitution * u[0];
    block->rise = rest * block->seek[0];
  }
  return true;
}

}  // namespace

Outcome solve_velocities(Problem& problem, Solver& solver) {
  aim_rebounds(problem);
  problem.bound_depth();
  constexpr int most_turns = 3;  // of limits: what is set in motion within the substep may pass the bound that is farther away
  Outcome outcome = solver.solve(problem);
  const auto solve_again = [&] {
    const int iterations = outcome.iterations;
    outcome = solver.solve(problem);
    outcome.iterations += iterations;
  };
  for (int i = 0; i < most_turns && problem.turn_limits(); ++i) solve_again();
  if (!problem.in_turn && aim_what_is_thrown(problem, solver)) solve_again();
  return outcome;
}

}  // namespace ziggurat::dynamics
