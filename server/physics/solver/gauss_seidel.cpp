// SPDX-License-Identifier: MIT
#include "physics/solver/gauss_seidel.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ziggurat::dynamics {
namespace {

/// A compile-time size, or the one that is given.
template <int N>
constexpr int size_of(int given) {
  return N < 0 ? given : N;
}

template <int N>
double dot(const double* row, const double* w, int n) {
  if constexpr (N == 6) {
    const double even = row[0] * w[0] + row[2] * w[2] + row[4] * w[4];
    const double odd = row[1] * w[1] + row[3] * w[3] + row[5] * w[5];
    return even + odd;
  }
  double sum = 0;
  for (int k = 0; k < size_of<N>(n); ++k) sum += row[k] * w[k];
  return sum;
}

template <int N>
void add_scaled(double factor, const double* row, double* w, int n) {
  for (int k = 0; k < size_of<N>(n); ++k) w[k] += factor * row[k];
}

/// M = C C^T in place, C lower, with the inverses of its diagonal.
void factor_in_place(double* m, int n) {
  for (int j = 0; j < n; ++j) {
    for (int k = 0; k < j; ++k) {
      const double factor = m[j * n + k];
      for (int i = j; i < n; ++i) m[i * n + j] -= factor * m[i * n + k];
    }
    const double inverse = 1 / std::sqrt(m[j * n + j]);
    for (int i = j + 1; i < n; ++i) m[i * n + j] *= inverse;
    m[j * n + j] = inverse;
  }
}

/// x := C^-1 x, of n values `stride` apart.
template <int N>
void whiten(const double* c, int size, double* x) {
  const int n = size_of<N>(size);
  for (int i = 0; i < n; ++i) {
    double sum = x[i];
    for (int k = 0; k < i; ++k) sum -= c[i * n + k] * x[k];
    x[i] = sum * c[i * n + i];
  }
}

/// x := C^-T x.
void unwhiten(const double* c, int n, double* x) {
  for (int i = n - 1; i >= 0; --i) {
    double sum = x[i];
    for (int k = i + 1; k < n; ++k) sum -= c[k * n + i] * x[k];
    x[i] = sum * c[i * n + i];
  }
}

}  // namespace

/// Factors of all mass matrices, with the joints' damping, and the velocities without impulses.
void GaussSeidel::factor(const Problem& problem) {
  w_ = problem.momentum;
  factors_.clear();
  factor_of_.clear();
  for (std::size_t i = 0; i < problem.trees.size(); ++i) {
    const Tree& tree = *problem.trees[i];
    const int n = tree.dofs, first = static_cast<int>(factors_.size());
    factor_of_.push_back(first);
    const double* mass = problem.mass_of(i);
    factors_.insert(factors_.end(), mass, mass + n * n);
    double* c = factors_.data() + first;
    for (int k = 0; k < n; ++k) c[k * n + k] += problem.time_step * tree.damping[k];
    factor_in_place(c, n);
    whiten<-1>(c, n, w_.data() + problem.offset[i]);
  }
}

void GaussSeidel::add(const Problem& problem, const Constraint& constraint, int index) {
  const int rows = acting_rows(constraint);
  if (rows == 0) return;
  const int trees[] = {constraint.a, constraint.b},
            jacobians[] = {constraint.jacobian_a, constraint.jacobian_b};
  int size[2] = {}, at[2] = {};
  for (int s = 0; s < 2; ++s) {
    if (trees[s] < 0) continue;
    size[s] = problem.trees[trees[s]]->dofs;
    at[s] = problem.offset[trees[s]];
  }
  if (pairs_.empty() || pairs_.back().a != at[0] || pairs_.back().b != at[1] ||
      pairs_.back().size_a != size[0] || pairs_.back().size_b != size[1]) {
    const int next = static_cast<int>(points_.size());
    pairs_.push_back({next, next, at[0], at[1], size[0], size[1]});
  }
  ++pairs_.back().last;
  const int first = static_cast<int>(rows_.size()), impulse = static_cast<int>(impulses_.size());
  points_.push_back(
      {index, first, impulse, rows, constraint.lower, constraint.upper, constraint.friction});
  rows_.resize(first + rows * (size[0] + size[1]));
  for (int r = 0; r < rows; ++r) {
    double square = 0;
    double* out = rows_.data() + first + r * (size[0] + size[1]);
    for (int s = 0; s < 2; ++s) {
      if (size[s] == 0) continue;
      const std::span<const int> dofs = s == 0 ? constraint.dofs_a : constraint.dofs_b;
      const double* row = problem.jacobian.data() + jacobians[s] + r * dofs.size();
      for (std::size_t e = 0; e < dofs.size(); ++e) out[dofs[e]] = row[e];
      const double* c = factors_.data() + factor_of_[trees[s]];
      size[s] == 6 ? whiten<6>(c, 6, out) : whiten<-1>(c, size[s], out);
      square += dot<-1>(out, out, size[s]);
      add_scaled<-1>(constraint.impulse[r], out, w_.data() + at[s], size[s]);
      out += size[s];
    }
    impulses_.push_back(constraint.impulse[r]);
    target_velocities_.push_back(constraint.target_velocity[r]);
    compliances_.push_back(r == 0 ? constraint.compliance : 0);
    inverse_.push_back(square > 0 ? 1 / (square + compliances_.back()) : 0);
  }
  coupling_.resize(impulses_.size(), 0.0);
  if (rows == 3) {
    const int width = size[0] + size[1];
    const double* row = rows_.data() + first;
    for (int r = 1; r < 3; ++r) coupling_[impulse + r] = dot<-1>(row, row + r * width, width);
  }
  // Both rows of a disc step alike: along the slip.
  for (const FrictionDisc& disc : discs_of(rows)) {
    double* inverse = inverse_.data() + impulse + disc.first;
    inverse[0] = inverse[disc.size - 1] = std::min(inverse[0], inverse[disc.size - 1]);
  }
}

void GaussSeidel::start(const Problem& problem) {
  points_.clear(), pairs_.clear(), rows_.clear();
  impulses_.clear(), target_velocities_.clear(), compliances_.clear(), inverse_.clear(),
      coupling_.clear();
  factor(problem);
  for (std::size_t i = 0; i < problem.constraints.size(); ++i) {
    add(problem, problem.constraints[i], static_cast<int>(i));
  }
  impulses_before_ = impulses_;
  w_before_ = w_;
  direction_.assign(impulses_.size(), 0);
  w_direction_.assign(w_.size(), 0);
  change_.assign(w_.size(), 0);
  square_ = 0;
}

/// A contact with sliding friction: the normal impulse, then friction at the speed that it leaves.
template <int A, int B>
void GaussSeidel::solve_sliding(const Rows& point, const Sides& sides) {
  const int na = size_of<A>(sides.size_a), nb = size_of<B>(sides.size_b), width = na + nb;
  double* const wa = sides.a;
  double* const wb = sides.b;
  const double* row0 = rows_.data() + point.first;
  double* g = impulses_.data() + point.impulse;
  const double* seek = target_velocities_.data() + point.impulse;
  const double* inverse = inverse_.data() + point.impulse;
  const double u0 = dot<A>(row0, wa, na) + dot<B>(row0 + na, wb, nb);
  const double normal = g[0] - (u0 + compliances_[point.impulse] * g[0] - seek[0]) * inverse[0];
  if (normal <= point.lower && g[0] == point.lower) return;
  const double* coupling = coupling_.data() + point.impulse;
  const double* row1 = row0 + width;
  const double* row2 = row1 + width;
  const double u1 = dot<A>(row1, wa, na) + dot<B>(row1 + na, wb, nb);
  const double u2 = dot<A>(row2, wa, na) + dot<B>(row2 + na, wb, nb);
  const double now = std::max(point.lower, normal), change0 = now - g[0];
  const double slip[] = {u1 + coupling[1] * change0, u2 + coupling[2] * change0};
  const double x1 = g[1] - (slip[0] - seek[1]) * inverse[1];
  const double x2 = g[2] - (slip[1] - seek[2]) * inverse[2];
  const double factor = friction_share(
      friction_bound(friction_discs[0], point.friction, now, slip).value, x1 * x1 + x2 * x2);
  const double change1 = factor * x1 - g[1], change2 = factor * x2 - g[2];
  g[0] = now, g[1] += change1, g[2] += change2;
  for (int k = 0; k < na; ++k) {
    wa[k] += change0 * row0[k] + change1 * row1[k] + change2 * row2[k];
  }
  row0 += na, row1 += na, row2 += na;
  for (int k = 0; k < nb; ++k) {
    wb[k] += change0 * row0[k] + change1 * row1[k] + change2 * row2[k];
  }
}

/// Any other constraint: the normal impulse or the only one, then friction of all kinds.
template <int A, int B>
void GaussSeidel::solve_other(const Rows& point, const Sides& sides) {
  const int na = size_of<A>(sides.size_a), nb = size_of<B>(sides.size_b);
  double* g = impulses_.data() + point.impulse;
  const auto row = [&](int r) { return rows_.data() + point.first + r * (na + nb); };
  const auto velocity = [&](int r) {
    return dot<A>(row(r), sides.a, na) + dot<B>(row(r) + na, sides.b, nb);
  };
  const auto wanted = [&](int r, double u) {
    const int i = point.impulse + r;
    return g[r] - (u + compliances_[i] * g[r] - target_velocities_[i]) * inverse_[i];
  };
  const auto give = [&](int r, double now) {
    const double change = now - g[r];
    if (change == 0) return;
    g[r] = now;
    add_scaled<A>(change, row(r), sides.a, na);
    add_scaled<B>(change, row(r) + na, sides.b, nb);
  };
  give(0, std::clamp(wanted(0, velocity(0)), point.lower, point.upper));
  for (const FrictionDisc& disc : discs_of(point.rows)) {
    double slip[2] = {}, x[2] = {}, square = 0;
    for (int r = 0; r < disc.size; ++r) {
      slip[r] = velocity(disc.first + r);
      x[r] = wanted(disc.first + r, slip[r]);
      square += x[r] * x[r];
    }
    const double factor =
        friction_share(friction_bound(disc, point.friction, g[0], slip).value, square);
    for (int r = 0; r < disc.size; ++r) give(disc.first + r, factor * x[r]);
  }
}

/// All points of two trees, whose velocities stay in registers meanwhile if they are single bodies.
template <int A, int B>
void GaussSeidel::solve_pair(const TreePair& pair) {
  constexpr bool known = A >= 0;
  Sides sides{w_.data() + pair.a, w_.data() + pair.b, pair.size_a, pair.size_b};
  [[maybe_unused]] double a[known ? A + 1 : 1], b[known ? B + 1 : 1];
  if constexpr (known) {
    std::copy_n(std::exchange(sides.a, a), A, a);
    std::copy_n(std::exchange(sides.b, b), B, b);
  }
  for (int i = pair.first; i < pair.last; ++i) {
    const Rows& point = points_[i];
    point.rows == 3 ? solve_sliding<A, B>(point, sides) : solve_other<A, B>(point, sides);
  }
  if constexpr (known) {
    std::copy_n(a, A, w_.data() + pair.a);
    std::copy_n(b, B, w_.data() + pair.b);
  }
}

void GaussSeidel::pass() {
  for (const TreePair& pair : pairs_) {
    if (pair.size_a == 6 && pair.size_b == 6) {
      solve_pair<6, 6>(pair);
    } else if (pair.size_a == 6 && pair.size_b == 0) {
      solve_pair<6, 0>(pair);
    } else {
      solve_pair<-1, -1>(pair);
    }
  }
}

double GaussSeidel::relative_change() const {
  double change = 0, all = 0;
  for (std::size_t i = 0; i < w_.size(); ++i) {
    const double difference = w_[i] - w_before_[i];
    change += difference * difference;
    all += w_[i] * w_[i];
  }
  return all > 0 ? std::sqrt(change / all) : 0;
}

/// The step along the direction of the passes before, by the rule of Polak and Ribiere; lengths are
/// those of w, the roots of twice the kinetic energy. Impulses may leave their bounds by it, until
/// the next pass.
void GaussSeidel::accelerate() {
  double square = 0, mixed = 0;
  for (std::size_t i = 0; i < w_.size(); ++i) {
    const double change = w_[i] - w_before_[i];
    square += change * change;
    mixed += change * change_[i];
    change_[i] = change;
  }
  const double ratio = square_ > 0 ? std::max(0.0, (square - mixed) / square_) : 0;
  const bool again = ratio > 1;  // the directions before say nothing any more
  square_ = square;
  const auto go = [&](std::vector<double>& now, std::vector<double>& before,
                      std::vector<double>& direction) {
    for (std::size_t i = 0; i < now.size(); ++i) {
      const double change = now[i] - before[i], along = again ? 0 : ratio * direction[i];
      now[i] += along;
      direction[i] = along + change;
      before[i] = now[i];
    }
  };
  go(impulses_, impulses_before_, direction_);
  go(w_, w_before_, w_direction_);
}

void GaussSeidel::finish(Problem& problem) const {
  problem.velocity = w_;
  for (std::size_t i = 0; i < problem.trees.size(); ++i) {
    unwhiten(factors_.data() + factor_of_[i], problem.trees[i]->dofs,
             problem.velocity.data() + problem.offset[i]);
  }
  for (const Rows& point : points_) {
    Constraint& constraint = problem.constraints[point.block];
    std::copy_n(impulses_.begin() + point.impulse, point.rows, constraint.impulse.begin());
  }
}

}  // namespace ziggurat::dynamics
