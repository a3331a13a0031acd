// Newton's method on the softened problem: impulses give way about an anchor, the impulses known so
// far. From the impulses of the last substep a heap at rest takes one step of it.

#include <algorithm>
#include <cmath>

#include "dynamics/newton.h"
#include "dynamics/constraint_hessian.h"

namespace ziggurat::dynamics {

/// out += J^T impulse of a block.
void add_impulse(const Problem& problem, const Block& block, const double* impulse,
                 std::vector<double>& out) {
  const auto add_side = [&](int place, int first, std::span<const int> dofs) {
    if (place < 0) return;
    by_rows(block.rows, [&](auto rows) {
      constexpr int R = rows();
      const double* columns = problem.jacobian.data() + first;
      double* to = out.data() + problem.offset[place];
      const auto add = [&](int k) {
        double sum = columns[k * R] * impulse[0];
        for (int r = 1; r < R; ++r) sum += columns[k * R + r] * impulse[r];
        to[k] += sum;
      };
      const bool leading = leads(dofs);
      for (int k = 0; k < 6 && leading; ++k) add(k);
      for (std::size_t e = leading ? 6 : 0; e < dofs.size(); ++e) add(dofs[e]);
    });
  };
  add_side(block.a, block.ja, block.dofs_a);
  add_side(block.b, block.jb, block.dofs_b);
}

namespace {

/// Whether a block has an impulse.
bool gives(const Block& block) {
  return std::any_of(block.impulse.begin(), block.impulse.begin() + block.rows,
                     [](double impulse) { return impulse != 0; });
}

}  // namespace

/// out := p + J^T g - M v, with the joints' damping in M.
/// @return  the largest change of a coordinate's speed that is missing, about [m/s] or [rad/s]
double imbalance(const Problem& problem, std::vector<double>& out) {
  out = problem.momentum;
  for (const Block& block : problem.blocks) {
    if (gives(block)) add_impulse(problem, block, block.impulse.data(), out);
  }
  double worst = 0;
  for (std::size_t i = 0; i < problem.trees.size(); ++i) {
    const Tree& tree = *problem.trees[i];
    const int n = tree.dofs;
    const double* mass = problem.mass_of(i);
    const double* v = problem.velocity.data() + problem.offset[i];
    double* to = out.data() + problem.offset[i];
    for (int r = 0; r < n; ++r) {
      double sum = problem.length * tree.damping[r] * v[r];
      for (int c = 0; c < n; ++c) sum += mass[r * n + c] * v[c];
      to[r] -= sum;
      worst = std::max(worst, std::abs(to[r]) / mass[r * n + r]);
    }
  }
  return worst;
}

bool is_balanced(const Problem& problem, std::span<const double> missing, double share, double least, std::vector<double>& given) {
  given.assign(problem.momentum.size(), 0.0);
  const auto add_side = [&](const Block& block, int place, int first, std::span<const int> dofs) {
    for (std::size_t e = 0; place >= 0 && e < dofs.size(); ++e) {
      double& sum = given[problem.offset[place] + dofs[e]];
      for (int r = 0; r < block.rows; ++r) sum += std::abs(problem.jacobian[first + dofs[e] * block.rows + r] * block.impulse[r]);
    }
  };
  for (const Block& block : problem.blocks) {
    if (!gives(block)) continue;
    add_side(block, block.a, block.ja, block.dofs_a);
    add_side(block, block.b, block.jb, block.dofs_b);
  }
  for (std::size_t i = 0; i < problem.trees.size(); ++i) {
    const int n = problem.trees[i]->dofs;
    for (int k = 0; k < n; ++k) {
      const int place = problem.offset[i] + k;
      const double enough = share * (given[place] + std::abs(problem.momentum[place])) + least * problem.mass_of(i)[k * n + k];
      if (std::abs(missing[place]) > enough) return false;
    }
  }
  return true;
}

namespace {

/// Impulses of the softened law at speeds.
/// @param linear  out: its linearisations; may be null
void soften(Problem& problem, std::span<const std::array<double, Block::most_rows>> speeds,
            double softness, bool anchors, Linear* linear) {
  for (std::size_t k = 0; k < problem.blocks.size(); ++k) {
    Block& block = problem.blocks[k];
    soften(block, speeds[k].data(), softness, anchors, block.impulse.data(), linear ? linear + k : nullptr);
  }
}

/// The square of the momentum that is missing, over the masses [J].
double square(const Problem& problem, const std::vector<double>& missing) {
  double sum = 0;
  for (std::size_t i = 0; i < missing.size(); ++i) {
    sum += missing[i] * missing[i] * problem.inverse_mass[i];
  }
  return sum;
}

}  // namespace

/// One step, about the anchors or about none: then what yields carries what it is pressed in by. Speeds must be taken, and are taken at the velocities that it finds.
/// @param shortest    part of the way; below 1 it goes as far as it leaves less momentum missing
/// @param unbalanced  out: the largest change of a coordinate's speed that is missing
/// @return            false if no step does
bool Solver::proximal_step(Problem& problem, double softness, bool anchors, double shortest, double& unbalanced) {
  constexpr double enough = 0.1;
  start_matrix(problem, matrix_);
  soften(problem, speeds_, softness, anchors, linear_.data());
  for (std::size_t k = 0; k < problem.blocks.size(); ++k) {
    add_slope(problem, problem.blocks[k], linear_[k], sloped_, matrix_);
  }
  unbalanced = imbalance(problem, residual_);
  const double before = square(problem, residual_);
  if (before == 0) return true;
  direction_ = residual_;
  if (!matrix_.factor()) return false;
  matrix_.solve(direction_.data());
  kept_velocity_ = problem.velocity;
  for (double way = 1; way >= shortest; way /= 2) {
    for (std::size_t k = 0; k < direction_.size(); ++k) {
      problem.velocity[k] = kept_velocity_[k] + way * direction_[k];
    }
    take_speeds(problem);
    soften(problem, speeds_, softness, anchors, nullptr);
    unbalanced = imbalance(problem, residual_);
    if (shortest == 1) return true;
    if (square(problem, residual_) < (1 - enough * way) * before) return true;
  }
  return false;
}

/// Full steps as long as they lead nearer to the law.
/// @return  whether the miss became small; otherwise the problem holds the best state met
bool Solver::proximal(Problem& problem, Outcome& outcome) {
  double scale = 0, unbalanced = 0;
  take_speeds(problem);
  double before = std::max(miss_now(problem, scale), imbalance(problem, residual_));
  snapshot_.take(problem);
  double best = before;
  for (Block& block : problem.blocks) block.anchor = block.impulse;
  bool enough = false;
  for (int i = 0; i < options.most_descents; ++i) {
    ++outcome.descents;
    if (!proximal_step(problem, options.softness, true, 1, unbalanced)) break;
    const double law = miss_now(problem, scale), now = std::max(law, unbalanced);
    if (!(now < HUGE_VAL)) break;
    if (now < best) {
      best = now;
      snapshot_.take(problem);
    }
    if (now <= options.tolerance(scale)) return outcome.miss = now, true;
    enough = best <= options.tolerance_of_softened(beginning_, scale);
    if (i > 0 && now > 0.3 * before) break;
    before = now;
    if (unbalanced <= 0.1 * law) {
      for (Block& block : problem.blocks) block.anchor = block.impulse;
    }
  }
  snapshot_.give_back(problem);
  outcome.miss = best;
  return enough;
}

/// Steps that lead nearer to the law: from anchor to anchor, with less softness where few steps
/// are enough for one, and more where many are not.
/// What strikes need not be as exact as what stands and must not creep.
/// @return  whether the miss became small; otherwise the problem holds the best state met
bool Solver::patient_proximal(Problem& problem, Outcome& outcome) {
  constexpr int few = 5, many = 15;
  constexpr double hardest = 1e-7, softest = 1, shortest = 1e-4;
  double scale = 0, unbalanced = 0, softness = options.softness;
  take_speeds(problem);
  double best = std::max(miss_now(problem, scale), imbalance(problem, residual_));
  double at_anchor = HUGE_VAL;
  snapshot_.take(problem);
  anchored_ = problem.velocity;
  for (Block& block : problem.blocks) block.anchor = block.impulse;
  bool enough = false;
  for (int i = 0, steps = 1; i < options.most_patient; ++i, ++steps) {
    ++outcome.descents;
    const bool nearer = proximal_step(problem, softness, true, shortest, unbalanced);
    const double law = miss_now(problem, scale), now = std::max(law, unbalanced);
    if (nearer && now < best) {
      best = now;
      snapshot_.take(problem);
    }
    if (nearer && now <= options.tolerance(scale)) return outcome.miss = now, true;
    enough = best <= options.tolerance_of_softened(beginning_, scale);
    if (enough && beginning_.strikes()) break;
    if (!nearer || steps > many) {
      if (enough || softness >= softest) break;
      softness *= 10, steps = 0;
      problem.velocity = anchored_;
      take_speeds(problem);
    } else if (unbalanced <= 0.1 * law) {
      if (enough && law > 0.3 * at_anchor) break;  // no nearer
      at_anchor = law;
      for (Block& block : problem.blocks) block.anchor = block.impulse;
      anchored_ = problem.velocity;
      if (steps <= few) softness = std::max(hardest, softness / 10);
      steps = 0;
    }
  }
  snapshot_.give_back(problem);
  outcome.miss = best;
  return enough;
}

/// The softened problem about no anchor, less and less soft, so friction is viscous until it slides: what slides by a little, as the
/// two ends of a wheel's line do, sticks and slides by turns in steps that know of no friction between.
void Solver::ease(Problem& problem, Outcome& outcome) {
  constexpr double softest = 1, hardest = 1e-5, shortest = 1e-3, balanced = 1e-2;
  constexpr int most = 10;
  take_speeds(problem);
  for (double softness = softest; softness > 0.9 * hardest; softness /= 3) {
    for (int i = 0; i < most; ++i) {
      double unbalanced = 0, scale = 0;
      ++outcome.descents;
      if (!proximal_step(problem, softness, false, shortest, unbalanced)) break;
      miss_now(problem, scale);
      if (unbalanced <= balanced * scale) break;
    }
  }
}

}  // namespace ziggurat::dynamics
