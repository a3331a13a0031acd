#include "dynamics/newton.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "dynamics/constraint_hessian.h"

namespace ziggurat::dynamics {
namespace {

using Speeds = std::vector<std::array<double, Block::most_rows>>;

/// right += the columns of a side times the impulses of R rows.
template <int R>
void add_impulse_of(const double* columns, std::span<const int> dofs, const double* impulse,
                    double* right) {
  const auto add = [&](int k) {
    double sum = right[k];
    for (int r = 0; r < R; ++r) sum += columns[k * R + r] * impulse[r];
    right[k] = sum;
  };
  const bool leading = leads(dofs);
  for (int k = 0; k < 6 && leading; ++k) add(k);
  for (std::size_t e = leading ? 6 : 0; e < dofs.size(); ++e) add(dofs[e]);
}

/// out += J^T impulse of a block, row by row.
void add_rows_of(const Problem& problem, const Block& block, const double* impulse,
                 std::vector<double>& out) {
  const auto add_side = [&](int place, int first, std::span<const int> dofs) {
    if (place < 0) return;
    by_rows(block.rows, [&](auto rows) {
      add_impulse_of<rows()>(problem.jacobian.data() + first, dofs, impulse,
                             out.data() + problem.offset[place]);
    });
  };
  add_side(block.a, block.ja, block.dofs_a);
  add_side(block.b, block.jb, block.dofs_b);
}

/// A block's impulses by its linearised law.
template <int R>
void take_impulse(const Linear& linear, const double* u, Block& block) {
  for (int r = 0; r < R; ++r) {
    double sum = linear.constant[r];
    for (int c = 0; c < R; ++c) sum -= linear.slope[r * R + c] * u[c];
    block.impulse[r] = sum;
  }
}

/// What the linearised law changes of a block's impulses from speeds u to speeds w.
template <int R>
void change_impulse(const Linear& linear, const double* u, const double* w, Block& block) {
  double change[R];
  for (int c = 0; c < R; ++c) change[c] = w[c] - u[c];
  for (int r = 0; r < R; ++r) {
    double sum = block.impulse[r];
    for (int c = 0; c < R; ++c) sum -= linear.slope[r * R + c] * change[c];
    block.impulse[r] = sum;
  }
}

/// The sum of a block's speeds and impulses, which is no number if one of them is none.
/// @param scale  grows to the largest speed, or change of speed by an impulse
template <int R>
double add_to_scale(const Block& block, const double* u, double& scale) {
  double sum = 0;
  for (int r = 0; r < R; ++r) {
    const double speed = std::abs(u[r]), impulse = std::abs(block.impulse[r]);
    sum += speed + impulse;
    scale = std::max(scale, std::max(speed, impulse * block.mobility[r]));
  }
  return sum;
}

/// @param scale      out: the largest of the contacts' speeds, or change of speed by an impulse; of servos and limits
///                   where nothing touches: a fast wheel does not say how exact contacts must be
/// @param of_joints  out: of servos and limits
/// @return           false if a speed or an impulse is no number
bool find_scale(const Problem& problem, const Speeds& speeds, double& scale, double& of_joints) {
  double sum = 0;
  scale = of_joints = 0;
  for (std::size_t i = 0; i < problem.blocks.size(); ++i) {
    const Block& block = problem.blocks[i];
    by_rows(block.rows, [&](auto rows) {
      sum += add_to_scale<rows()>(block, speeds[i].data(),
                                  block.kind == Block::Source::contact ? scale : of_joints);
    });
  }
  if (scale == 0) scale = of_joints;
  return std::isfinite(sum);  // the maxima skip what is no number
}

/// @param enough  a miss of more need not be exact
double miss_beyond(const Problem& problem, const Speeds& speeds, double enough) {
  double worst = 0;
  for (std::size_t i = 0; i < problem.blocks.size() && worst <= enough; ++i) {
    worst = std::max(worst, miss(problem.blocks[i], speeds[i].data()));
  }
  return worst;
}

/// Of all blocks, see contact_law.h [J].
double wrong_energy(const Problem& problem, const Speeds& speeds) {
  double sum = 0;
  for (std::size_t i = 0; i < problem.blocks.size(); ++i) {
    sum += dynamics::wrong_energy(problem.blocks[i], speeds[i].data());
  }
  return sum;
}

/// Whether masses are so alike that what is little for the speeds of one tree is so for those of another.
bool are_alike(std::span<const double> masses) {
  constexpr double most = 100;  // the heaviest over the lightest
  const auto [least, greatest] = std::ranges::minmax(masses);
  return greatest <= most * least;
}

/// Of a problem that is not solved yet.
Beginning beginning_of(const Problem& problem) {
  Beginning out;
  for (const Block& block : problem.blocks) {
    if (block.kind != Block::Source::contact) continue;
    double u[Block::most_rows];
    problem.speeds(block, u);
    for (int r = 0; r < std::min(block.rows, 3); ++r) out.fastest = std::max(out.fastest, std::abs(u[r]));
  }
  for (const Tree* tree : problem.trees) out.fall = std::max(out.fall, problem.length * tree->gravity.norm());
  return out;
}

}  // namespace

void start_matrix(const Problem& problem, BlockMatrix& matrix) {
  matrix.clear();
  for (std::size_t i = 0; i < problem.trees.size(); ++i) {
    const Tree& tree = *problem.trees[i];
    double* block = matrix.block(static_cast<int>(i), static_cast<int>(i));
    std::copy_n(problem.mass_of(i), tree.dofs * tree.dofs, block);
    for (int k = 0; k < tree.dofs; ++k) {
      block[k * tree.dofs + k] += problem.length * tree.damping[k];
    }
  }
}

/// The speeds of all blocks at the present velocities.
void Solver::take_speeds(const Problem& problem) {
  speeds_.resize(problem.blocks.size());
  for (std::size_t i = 0; i < speeds_.size(); ++i) {
    problem.speeds(problem.blocks[i], speeds_[i].data());
  }
}

/// One step of Newton's method. Speeds must be taken, and are taken at the velocities that it
/// finds.
/// @return  false if the matrix has no factors; then nothing has changed
bool Solver::step(Problem& problem) {
  kept_velocity_ = problem.velocity;
  start_matrix(problem, matrix_);
  problem.velocity = problem.momentum;
  for (std::size_t i = 0; i < problem.blocks.size(); ++i) {
    linearise(problem.blocks[i], speeds_[i].data(), linear_[i]);
    add_slope(problem, problem.blocks[i], linear_[i], sloped_, matrix_);
    if (linear_[i].zero) continue;
    add_rows_of(problem, problem.blocks[i], linear_[i].constant.data(), problem.velocity);
  }
  if (!matrix_.factor()) {
    problem.velocity = kept_velocity_;
    return false;
  }
  matrix_.solve(problem.velocity.data());
  take_speeds(problem);
  for (std::size_t i = 0; i < problem.blocks.size(); ++i) {
    Block& block = problem.blocks[i];
    const Linear& linear = linear_[i];
    if (linear.zero) {
      block.impulse.fill(0);
      continue;
    }
    by_rows(block.rows, [&](auto rows) { take_impulse<rows()>(linear, speeds_[i].data(), block); });
  }
  return true;
}

/// One more step with the factors of the last one, for what it left: near the solution the matrix
/// hardly changes. Speeds must be taken, and are taken at the velocities that it finds.
void Solver::correct(Problem& problem) {
  for (std::size_t i = 0; i < problem.blocks.size(); ++i) {
    Block& block = problem.blocks[i];
    linearise(block, speeds_[i].data(), now_);
    if (now_.zero) {
      block.impulse.fill(0);
      continue;
    }
    by_rows(block.rows, [&](auto rows) { take_impulse<rows()>(now_, speeds_[i].data(), block); });
  }
  imbalance(problem, residual_);
  kept_speeds_ = speeds_;
  matrix_.solve(residual_.data());
  for (std::size_t k = 0; k < residual_.size(); ++k) problem.velocity[k] += residual_[k];
  take_speeds(problem);
  for (std::size_t i = 0; i < problem.blocks.size(); ++i) {
    if (linear_[i].zero) continue;
    by_rows(problem.blocks[i].rows, [&](auto rows) {
      change_impulse<rows()>(linear_[i], kept_speeds_[i].data(), speeds_[i].data(),
                             problem.blocks[i]);
    });
  }
}

/// At the speeds that were taken.
/// @param scale  out: see find_scale()
/// @return       infinite if a speed or an impulse is no number
double Solver::miss_now(const Problem& problem, double& scale) const {
  double of_joints = 0;
  return find_scale(problem, speeds_, scale, of_joints) ? miss_beyond(problem, speeds_, HUGE_VAL) : HUGE_VAL;
}

void Snapshot::take(const Problem& problem) {
  velocity = problem.velocity;
  impulses.clear();
  for (const Block& block : problem.blocks) impulses.push_back(block.impulse);
}

void Snapshot::give_back(Problem& problem) const {
  problem.velocity = velocity;
  for (std::size_t i = 0; i < impulses.size(); ++i) problem.blocks[i].impulse = impulses[i];
}

void Snapshot::draw_back(Problem& problem, double share) const {
  for (std::size_t k = 0; k < velocity.size(); ++k) {
    problem.velocity[k] += share * (velocity[k] - problem.velocity[k]);
  }
  for (std::size_t i = 0; i < impulses.size(); ++i) {
    for (int r = 0; r < problem.blocks[i].rows; ++r) {
      double& impulse = problem.blocks[i].impulse[r];
      impulse += share * (impulses[i][r] - impulse);
    }
  }
}

/// Halves a step of Newton's method, from `earlier_`, until less is wrong than before.
/// @param wrong  see wrong_energy(): before; out: after
void Solver::shorten(Problem& problem, double& wrong) {
  constexpr int most = 6;
  const double before = wrong;
  for (int i = 0; i <= most; ++i) {
    wrong = wrong_energy(problem, speeds_);
    if (wrong < before || i == most) return;
    earlier_.draw_back(problem, 0.5);
    take_speeds(problem);
  }
}

/// Steps with the factors of the last one.
/// @return  whether they converged; otherwise the problem holds the best state met
bool Solver::correct_while_nearer(Problem& problem, Outcome& outcome) {
  constexpr int most = 3;
  constexpr double much = 0.1;  // less: new factors are worth their time
  double scale = 0;
  for (int i = 0; i < most; ++i) {
    const double before = outcome.miss;
    earlier_.take(problem);
    correct(problem);
    outcome.miss = miss_now(problem, scale);
    if (outcome.miss <= options.tolerance(scale)) return true;
    if (outcome.miss > before) {  // where contacts are redundant it may lead far away
      earlier_.give_back(problem);
      take_speeds(problem);
      outcome.miss = before;
    }
    if (outcome.miss > much * before) return false;
  }
  return false;
}

/// Newton's method from the present state, whose speeds are taken. From the third step on it goes only as far as less is
/// wrong: it went round, as between the two ends of a wheel's line that stick and slide by turns while its motor gives
/// all that it has.
/// @param most_far  iterations that lead no nearer and miss the law by much
/// @return          whether it converged; then the problem holds the solution
bool Solver::iterate(Problem& problem, Outcome& outcome, int most_far) {
  double scale = 0, wrong = HUGE_VAL;
  int far = 0;
  for (int i = 0; i < options.most_iterations; ++i) {
    const bool shortens = i > 1;
    const double wrong_before = wrong;
    if (shortens) earlier_.take(problem);
    if (!step(problem)) return false;
    ++outcome.iterations;
    if (shortens) shorten(problem, wrong);
    outcome.miss = miss_now(problem, scale);
    if (outcome.miss <= options.tolerance(scale)) return true;
    if (!shortens) wrong = wrong_energy(problem, speeds_);
    const bool nears = wrong < 0.5 * wrong_before;
    if (outcome.miss > options.far * scale && !nears && ++far >= most_far) return false;
    if (outcome.miss <= options.rounding * scale && !nears) return true;
    if (outcome.miss > options.near * scale) continue;
    if (correct_while_nearer(problem, outcome)) return true;
    wrong = wrong_energy(problem, speeds_);
  }
  return false;
}

/// Shapes the matrix, if it is not too large for that, and keeps the state.
/// @return  multiplications that a factorisation takes
double Solver::start(Problem& problem) {
  start_.take(problem);
  beginning_ = beginning_of(problem);
  if (problem.trees.size() > options.most_trees) return HUGE_VAL;
  sizes_.clear();
  for (const Tree* tree : problem.trees) sizes_.push_back(tree->dofs);
  matrix_.shape(sizes_, problem.couplings);
  linear_.resize(problem.blocks.size());
  return matrix_.work();
}

/// Whether the velocities and impulses of the last substep still solve the problem.
bool Solver::still_solved(const Problem& problem, Outcome& outcome) {
  double scale = 0, of_joints = 0;
  take_speeds(problem);
  const bool finite = find_scale(problem, speeds_, scale, of_joints);
  const double enough = options.tolerance(scale);
  outcome.miss = finite ? miss_beyond(problem, speeds_, enough) : HUGE_VAL;
  if (outcome.miss > enough) return false;
  const double balanced = options.absolute_tolerance + options.still_tolerance * std::max(scale, of_joints);
  if (imbalance(problem, residual_) > balanced) return false;
  return are_alike(problem.total_mass) || is_balanced(problem, residual_, options.still_tolerance, options.absolute_tolerance, given_);
}

Outcome Solver::solve(Problem& problem) {
  Outcome outcome;
  if (still_solved(problem, outcome)) return outcome;
  const double work = start(problem);
  if (work > options.most_work) {
    problem.harden();
    sweep_until_converged(problem, outcome, options.most_sweeps);
    return outcome;
  }
  if (options.suits_newton(problem.trees.size(), work)) {
    if (iterate(problem, outcome, options.most_far)) return outcome;
    start_.give_back(problem);
    ease(problem, outcome);
    outcome.converged = patient_proximal(problem, outcome);
    if (!outcome.converged) {
      start_.give_back(problem);
      soften_after_sweeps(problem, outcome);
    }
    if (outcome.converged) {
      sharpen(problem, outcome);
      return outcome;
    }
    start_.give_back(problem);
    problem.harden();
  } else {
    problem.harden();
    if (proximal(problem, outcome)) return outcome;
  }
  start_.give_back(problem);
  const bool found = interior_points(problem, outcome);
  outcome.converged = proximal(problem, outcome);
  if (outcome.converged && found) return outcome;
  const Outcome before = outcome;  // where redundant contacts hold each other up, their impulses hide a miss
  start_.take(problem);
  soften_after_sweeps(problem, outcome);
  if (outcome.miss > before.miss) {
    start_.give_back(problem);
    outcome.miss = before.miss;
    outcome.converged = before.converged;
  }
  return outcome;
}

void Solver::solve_without_rebound(Problem& problem, Snapshot& out) {
  rebounding_.take(problem);
  seeks_.clear();
  for (Block& block : problem.blocks) {
    seeks_.push_back(block.seek[0]);
    if (block.bounces) block.seek[0] = -std::max(0.0, block.gap) / problem.length;
  }
  solve(problem);
  out.take(problem);
  rebounding_.give_back(problem);
  for (std::size_t i = 0; i < seeks_.size(); ++i) problem.blocks[i].seek[0] = seeks_[i];
}

bool Solver::sweep_until_converged(Problem& problem, Outcome& outcome, int most) {
  constexpr int between = 10;  // sweeps from one look at the miss to the next
  sweeps_.start(problem);
  for (int sweep = 1; sweep <= most; ++sweep) {
    ++outcome.sweeps;
    sweeps_.sweep();
    if (sweep % between != 0 && sweep < most) {
      sweeps_.accelerate();
      continue;
    }
    sweeps_.finish(problem);
    double scale = 0;
    take_speeds(problem);
    outcome.miss = miss_now(problem, scale);
    outcome.converged = outcome.miss <= options.tolerance_of_softened(beginning_, scale);
    if (outcome.converged) return true;
    sweeps_.accelerate();
  }
  return false;
}

/// Newton's method from a solution of the softened problem: it misses by more than soft surfaces give way, and would share loads
/// at random.
void Solver::sharpen(Problem& problem, Outcome& outcome) {
  const double before = outcome.miss;
  start_.take(problem);
  take_speeds(problem);
  if (iterate(problem, outcome, options.most_far)) return;
  start_.give_back(problem);
  outcome.miss = before;
}

/// Some sweeps, then the softened problem from where they end. Sweeps find which contacts hold,
/// stick and slide; where some of them contradict each other a little, as rolling friction and the
/// two ends of a line do, only the softened problem ends.
bool Solver::soften_after_sweeps(Problem& problem, Outcome& outcome) {
  sweeps_.start(problem);
  for (int sweep = 1; sweep <= options.first_sweeps; ++sweep) {
    sweeps_.sweep();
    if (sweep < options.first_sweeps) sweeps_.accelerate();
  }
  sweeps_.finish(problem);
  outcome.sweeps += options.first_sweeps;
  return outcome.converged = patient_proximal(problem, outcome);
}

void Solver::solve_displacement(Problem& problem) {
  Outcome outcome;
  const double work = start(problem);
  if (options.suits_newton(problem.trees.size(), work)) {
    take_speeds(problem);
    if (iterate(problem, outcome, options.most_iterations)) return;
    start_.give_back(problem);
  }
  sweep_until_converged(problem, outcome, options.displacement_sweeps);
  if (outcome.miss > options.displacement_miss && work <= options.most_work) patient_proximal(problem, outcome);
}

}  // namespace ziggurat::dynamics
