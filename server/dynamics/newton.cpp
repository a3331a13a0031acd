#include "dynamics/newton.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ziggurat::dynamics {
namespace {

/// One side of a block of R rows.
struct Side {
  int place = -1;                   // of its tree in the island
  int dofs = 0;                     // of the tree
  const double* columns = nullptr;  // R values per dof
  std::span<const int> touched;     // dofs whose columns are not zero, ascending
  int leading = 0;                  // so many of them are the first dofs of the tree: 6 or 0
};

Side side_of(const Problem& problem, int place, int first, std::span<const int> dofs) {
  const Tree& tree = *problem.trees[place];
  return {place, tree.dofs, problem.jacobian.data() + first, dofs,
          tree.free_root && dofs.size() >= 6 ? 6 : 0};
}

/// sloped := slope times the columns of a side, row by row, one entry per touched dof.
template <int R>
void apply_slope(const double* slope, const Side& side, double* sloped) {
  const std::size_t count = side.touched.size();
  for (std::size_t e = 0; e < count; ++e) {
    const double* column = side.columns + side.touched[e] * R;
    for (int r = 0; r < R; ++r) {
      double sum = 0;
      for (int c = 0; c < R; ++c) sum += slope[r * R + c] * column[c];
      sloped[r * count + e] = sum;
    }
  }
}

/// A row of the matrix += column^T sloped.
/// @param L  how many of the dofs are leading: the compiler knows their number
template <int R, int L>
void add_to_row(const double* column, const Side& side, const double* sloped, double* row) {
  const std::size_t count = side.touched.size();
  double leading[L > 0 ? L : 1];
  for (int j = 0; j < L; ++j) leading[j] = row[j];
  for (int r = 0; r < R; ++r) {
    for (int j = 0; j < L; ++j) leading[j] += column[r] * sloped[r * count + j];
  }
  for (int j = 0; j < L; ++j) row[j] = leading[j];
  for (std::size_t e = L; e < count; ++e) {
    double sum = row[side.touched[e]];
    for (int r = 0; r < R; ++r) sum += column[r] * sloped[r * count + e];
    row[side.touched[e]] = sum;
  }
}

/// Adds J^T slope J of a block of R rows to the matrix.
template <int R>
void add_slope_of(const Problem& problem, const Block& block, const double* slope,
                  std::vector<double>& sloped, BlockMatrix& matrix) {
  Side sides[2];
  if (block.a >= 0) sides[0] = side_of(problem, block.a, block.ja, block.dofs_a);
  if (block.b >= 0) sides[1] = side_of(problem, block.b, block.jb, block.dofs_b);
  for (const Side& s : sides) {
    if (s.place < 0) continue;
    sloped.resize(s.touched.size() * R);
    apply_slope<R>(slope, s, sloped.data());
    for (const Side& t : sides) {
      if (t.place < 0) continue;
      double* out = matrix.block(t.place, s.place);
      for (const int k : t.touched) {
        if (s.leading == 6) {
          add_to_row<R, 6>(t.columns + k * R, s, sloped.data(), out + k * s.dofs);
        } else {
          add_to_row<R, 0>(t.columns + k * R, s, sloped.data(), out + k * s.dofs);
        }
      }
    }
  }
}

/// Whether a contact is faster than what one substep's forces give.
bool has_strike(const Problem& problem) {
  double fastest = 0, forces = 0;
  for (const Block& block : problem.blocks) {
    double u[Block::most_rows];
    problem.speeds(block, u);
    for (int r = 0; r < std::min(block.rows, 3); ++r) fastest = std::max(fastest, std::abs(u[r]));
  }
  for (const Tree* tree : problem.trees) {
    forces = std::max(forces, problem.length * tree->gravity.norm());
  }
  return fastest > forces;
}

}  // namespace

/// Adds J^T slope J to the matrix.
void Solver::add_slope(const Problem& problem, const Block& block, const Linear& linear) {
  if (linear.zero) return;
  const double* slope = linear.slope.data();
  if (block.rows == 3) return add_slope_of<3>(problem, block, slope, sloped_, matrix_);
  if (block.rows == 1) return add_slope_of<1>(problem, block, slope, sloped_, matrix_);
  add_slope_of<6>(problem, block, slope, sloped_, matrix_);
}

/// Adds J^T constant to the right-hand side, which is in v.
void Solver::add_constant(Problem& problem, const Block& block, const Linear& linear) {
  if (linear.zero) return;
  const auto add_side = [&](int place, int first, std::span<const int> dofs) {
    if (place < 0) return;
    const int rows = block.rows;
    const double* columns = problem.jacobian.data() + first;
    const double* constant = linear.constant.data();
    double* right = problem.velocity.data() + problem.offset[place];
    for (const int k : dofs) {
      const double* column = columns + k * rows;
      double sum = right[k] + column[0] * constant[0];
      if (rows == 3) {
        sum += column[1] * constant[1];
        sum += column[2] * constant[2];
      } else {
        for (int r = 1; r < rows; ++r) sum += column[r] * constant[r];
      }
      right[k] = sum;
    }
  };
  add_side(block.a, block.ja, block.dofs_a);
  add_side(block.b, block.jb, block.dofs_b);
}

/// The mass matrices.
void Solver::start_matrix(Problem& problem) {
  matrix_.clear();
  for (std::size_t i = 0; i < problem.trees.size(); ++i) {
    const Tree& tree = *problem.trees[i];
    double* block = matrix_.block(static_cast<int>(i), static_cast<int>(i));
    std::copy(tree.mass.begin(), tree.mass.end(), block);
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
  start_matrix(problem);
  problem.velocity = problem.momentum;
  for (std::size_t i = 0; i < problem.blocks.size(); ++i) {
    linearise(problem.blocks[i], speeds_[i].data(), linear_[i]);
    add_slope(problem, problem.blocks[i], linear_[i]);
    add_constant(problem, problem.blocks[i], linear_[i]);
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
    const auto& u = speeds_[i];
    for (int r = 0; r < block.rows; ++r) {
      double sum = linear.constant[r];
      for (int c = 0; c < block.rows; ++c) sum -= linear.slope[r * block.rows + c] * u[c];
      block.impulse[r] = sum;
    }
  }
  return true;
}

/// At the speeds that were taken.
/// @param scale  out: the largest speed, or change of speed by an impulse
/// @return       infinite if a speed or an impulse is no number
double Solver::miss_now(const Problem& problem, double& scale) const {
  double worst = 0, sum = 0;
  scale = 0;
  for (std::size_t i = 0; i < problem.blocks.size(); ++i) {
    const Block& block = problem.blocks[i];
    const auto& u = speeds_[i];
    worst = std::max(worst, miss(block, u.data()));
    for (int r = 0; r < block.rows; ++r) {
      sum += std::abs(u[r]) + std::abs(block.impulse[r]);  // the maxima skip what is no number
      scale = std::max({scale, std::abs(u[r]), std::abs(block.impulse[r]) * block.mobility[r]});
    }
  }
  return std::isfinite(sum) ? worst : HUGE_VAL;
}

double Solver::worst_miss(const Problem& problem, double& scale) {
  take_speeds(problem);
  return miss_now(problem, scale);
}

void Solver::Snapshot::take(const Problem& problem) {
  velocity = problem.velocity;
  impulses.clear();
  for (const Block& block : problem.blocks) impulses.push_back(block.impulse);
}

void Solver::Snapshot::give_back(Problem& problem) const {
  problem.velocity = velocity;
  for (std::size_t i = 0; i < impulses.size(); ++i) problem.blocks[i].impulse = impulses[i];
}

/// Newton's method from the present state, whose speeds are taken.
/// @return  whether it converged; then the problem holds the solution
bool Solver::iterate(Problem& problem, Outcome& outcome, int most) {
  double scale = 0;
  for (int i = 0; i < most; ++i) {
    if (!step(problem)) return false;
    ++outcome.iterations;
    outcome.miss = miss_now(problem, scale);
    if (outcome.miss <= tolerance(scale)) return true;
  }
  return false;
}

/// Shapes the matrix, if it is not too large for that, and keeps the state.
/// @return  multiplications that a factorisation takes
double Solver::start(Problem& problem) {
  start_.take(problem);
  if (problem.trees.size() > options.most_trees) return HUGE_VAL;
  sizes_.clear();
  for (const Tree* tree : problem.trees) sizes_.push_back(tree->dofs);
  matrix_.shape(sizes_, problem.couplings);
  linear_.resize(problem.blocks.size());
  return matrix_.work();
}

/// Whether the velocities and impulses of the last substep still solve the problem.
bool Solver::still_solved(const Problem& problem, Outcome& outcome) {
  double scale = 0;
  outcome.miss = worst_miss(problem, scale);
  const double enough = options.absolute_tolerance + options.still_tolerance * scale;
  return outcome.miss <= enough && imbalance(problem, residual_) <= enough;
}

Outcome Solver::solve(Problem& problem) {
  Outcome outcome;
  if (still_solved(problem, outcome)) return outcome;
  const double work = start(problem);
  if (work > options.most_work) {
    sweep_until_converged(problem, outcome, options.most_sweeps);
    return outcome;
  }
  if (work <= options.newton_work) {
    if (iterate(problem, outcome, options.most_iterations)) return outcome;
    start_.give_back(problem);
    if (soften_after_sweeps(problem, outcome)) return outcome;
    start_.give_back(problem);
  } else if (proximal(problem, outcome)) {
    return outcome;
  }
  start_.give_back(problem);
  interior_points(problem, outcome);
  outcome.converged = proximal(problem, outcome);
  if (outcome.converged) return outcome;
  const double before = outcome.miss;
  start_.take(problem);
  if (!soften_after_sweeps(problem, outcome) && outcome.miss > before) {
    start_.give_back(problem);
    outcome.miss = before;
  }
  return outcome;
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
    outcome.miss = worst_miss(problem, scale);
    outcome.converged = outcome.miss <= soft_tolerance(scale);
    if (outcome.converged) return true;
    sweeps_.accelerate();
  }
  return false;
}

/// Some sweeps, then the softened problem from where they end. Sweeps find which contacts hold,
/// stick and slide; where some of them contradict each other a little, as rolling friction and the
/// two ends of a line do, only the softened problem ends.
bool Solver::soften_after_sweeps(Problem& problem, Outcome& outcome) {
  const bool strikes = has_strike(problem);
  sweeps_.start(problem);
  for (int sweep = 1; sweep <= options.first_sweeps; ++sweep) {
    sweeps_.sweep();
    if (sweep < options.first_sweeps) sweeps_.accelerate();
  }
  sweeps_.finish(problem);
  outcome.sweeps += options.first_sweeps;
  return outcome.converged = patient_proximal(problem, outcome, strikes);
}

void Solver::solve_displacement(Problem& problem) {
  Outcome outcome;
  const double work = start(problem);
  if (work <= options.newton_work) {
    take_speeds(problem);
    if (iterate(problem, outcome, options.most_iterations)) return;
    start_.give_back(problem);
  }
  sweep_until_converged(problem, outcome, options.displacement_sweeps);
}

}  // namespace ziggurat::dynamics
