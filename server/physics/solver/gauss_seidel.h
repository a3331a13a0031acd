// SPDX-License-Identifier: MIT
#pragma once
// Projected Gauss-Seidel passes, accelerated, for islands whose matrix is too expensive to factor,
// and for those for which no other method converged.
//
// Each contact in turn takes the impulses of its law with all others fixed (non-smooth
// Gauss-Seidel: M. Jean, Comput. Methods Appl. Mech. Eng. 177, 1999). The change by a pass is the
// residual of a nonlinear conjugate gradient method (M. Silcowitz-Hansen, S. Niebe, K. Erleben, The
// Visual Computer 26, 2010). It carries an impact through a heap in fewer passes.
//
// Velocities are in coordinates w = C^T v with M = C C^T, in which the mass matrix is 1. An impulse
// g of a row j changes w by j g, and the row's speed is j w. So a contact's data is one array that
// is read once, for any bodies.

#include <array>
#include <span>
#include <vector>

#include "physics/solver/problem.h"

namespace ziggurat::dynamics {

class GaussSeidel {
 public:
  /// Takes over a problem with its impulses; velocities follow from them.
  void start(const Problem& problem);
  /// Each constraint once.
  void pass();
  /// The conjugate direction's step, after a pass and before another.
  void accelerate();
  /// Writes velocities and impulses.
  void finish(Problem& problem) const;

  /// Change of the velocities by the last pass over the velocities, both as roots of twice the
  /// kinetic energy.
  double relative_change() const;

 private:
  /// A contact, servo or limit: its rows for both trees stand in rows_, one after the other.
  struct Rows {
    int block;                       // into Problem::constraints
    int first;                       // into rows_: of each row `a` and `b` values
    int impulse;                     // into impulses_, and so of seek_, yield_ and inverse_
    int rows;                        // that are solved
    double lower, upper;             // of the first impulse
    std::array<double, 3> friction;  // coefficients of the discs
  };
  /// Points of the same two trees, one after the other.
  struct TreePair {
    int first, last;
    int a, b;            // into w_
    int size_a, size_b;  // dofs; 0: the world
  };
  void factor(const Problem& problem);
  void add(const Problem& problem, const Constraint& constraint, int index);
  /// The velocities that a constraint's rows act on.
  struct Sides {
    double* a;
    double* b;
    int size_a, size_b;
  };
  template <int A, int B>
  void solve_pair(const TreePair& pair);
  template <int A, int B>
  void solve_sliding(const Rows& point, const Sides& sides);
  template <int A, int B>
  void solve_other(const Rows& point, const Sides& sides);

  std::vector<Rows> points_;
  std::vector<TreePair> pairs_;
  std::vector<double> rows_, w_;
  std::vector<double> factors_;  // C of all trees
  std::vector<int> factor_of_;   // of each tree, into factors_
  // Row data: impulse, target velocity, 1 / (j j^T), j j_normal^T.
  std::vector<double> impulses_, target_velocities_, compliances_, inverse_, coupling_;
  // Conjugate directions.
  std::vector<double> impulses_before_, w_before_, direction_, w_direction_, change_;
  double square_ = 0;
};

}  // namespace ziggurat::dynamics
