// SPDX-License-Identifier: MIT
#include "physics/solver/constraint_hessian.h"

#include <algorithm>

namespace ziggurat::dynamics {
namespace {

/// One side of a constraint of R rows.
struct Side {
  int index = -1;                // of its tree in the island
  int dofs = 0;                  // of the tree
  const double* rows = nullptr;  // see jacobian.h
  std::span<const int> touched;  // dofs that move it, ascending
  int leading = 0;               // 6 of a free root, or 0
  /// Entry of a row and a touched dof.
  double entry(int row, std::size_t e) const { return rows[row * touched.size() + e]; }
};

Side side_of(const Problem& problem, int index, int first, std::span<const int> dofs) {
  const Tree& tree = *problem.trees[index];
  return {index, tree.dofs, problem.jacobian.data() + first, dofs,
          tree.has_floating_base && begins_with_floating_base(dofs) ? 6 : 0};
}

/// Adds J^T H J of a constraint of R rows to the matrix: to the columns of side s, in the rows of
/// both sides. For any tree.
template <int R>
void add_any(const Side& s, const Side (&sides)[2], const double* slope,
             std::vector<double>& sloped, BlockMatrix& matrix) {
  const std::size_t count = s.touched.size();
  sloped.assign(count * R, 0.0);
  for (int r = 0; r < R; ++r) {
    for (int c = 0; c < R; ++c) {
      for (std::size_t e = 0; e < count; ++e)
        sloped[r * count + e] += slope[r * R + c] * s.entry(c, e);
    }
  }
  for (const Side& t : sides) {
    if (t.index < 0) continue;
    for (std::size_t f = 0; f < t.touched.size(); ++f) {
      double* row = matrix.block(t.index, s.index) + t.touched[f] * s.dofs;
      for (std::size_t e = 0; e < count; ++e) {
        double sum = row[s.touched[e]];
        for (int r = 0; r < R; ++r) sum += t.entry(r, f) * sloped[r * count + e];
        row[s.touched[e]] = sum;
      }
    }
  }
}

/// The same where s has a free root, whose six dofs lead the touched ones, and T more of them. The
/// compiler knows their number, and takes two at a time.
template <int R, int T>
void add_leading(const Side& s, const Side (&sides)[2], const double* slope, BlockMatrix& matrix) {
  using Six = Eigen::Array<double, 6, 1>;
  Six sloped[R];
  double tail[R][T + 1];
  for (int r = 0; r < R; ++r) {
    for (int c = 0; c < R; ++c) {
      if (!depends(r, c)) continue;
      const double factor = slope[r * R + c];
      const Eigen::Map<const Six> row(s.rows + c * (6 + T));
      if (c == 0) {
        sloped[r] = factor * row;
      } else {
        sloped[r] += factor * row;
      }
      for (int e = 0; e < T; ++e)
        tail[r][e] = (c == 0 ? 0 : tail[r][e]) + factor * s.rows[c * (6 + T) + 6 + e];
    }
  }
  for (const Side& t : sides) {
    if (t.index < 0) continue;
    double* out = matrix.block(t.index, s.index);
    const auto add = [&](std::size_t f, auto rows_of_dof) {
      double* row = out + t.touched[f] * s.dofs;
      Eigen::Map<Six> leading(row);
      Six sum = leading;
      for (int r = 0; r < rows_of_dof(); ++r) sum += t.entry(r, f) * sloped[r];
      leading = sum;
      for (int e = 0; e < T; ++e) {
        double entry = row[s.touched[6 + e]];
        for (int r = 0; r < rows_of_dof(); ++r) entry += t.entry(r, f) * tail[r][e];
        row[s.touched[6 + e]] = entry;
      }
    };
    using All = std::integral_constant<int, R>;
    // Moving a body, by dofs 3 to 5 of a free root, does not turn it.
    using Moving = std::integral_constant<int, std::min(R, 3)>;
    for (int k = 0; k < t.leading; ++k) k < 3 ? add(k, All()) : add(k, Moving());
    for (std::size_t f = t.leading; f < t.touched.size(); ++f) add(f, All());
  }
}

/// Adds J^T H J of a constraint of R rows to the matrix.
template <int R>
void add_slope_of(const Problem& problem, const Constraint& constraint, const double* slope,
                  std::vector<double>& sloped, BlockMatrix& matrix) {
  Side sides[2];
  if (constraint.a >= 0)
    sides[0] = side_of(problem, constraint.a, constraint.jacobian_a, constraint.dofs_a);
  if (constraint.b >= 0)
    sides[1] = side_of(problem, constraint.b, constraint.jacobian_b, constraint.dofs_b);
  for (const Side& s : sides) {
    if (s.index < 0) continue;
    const std::size_t more = s.touched.size() - s.leading;
    if (s.leading == 6 && more == 0) {
      add_leading<R, 0>(s, sides, slope, matrix);
    } else if (s.leading == 6 && more == 1) {
      add_leading<R, 1>(s, sides, slope, matrix);
    } else {
      add_any<R>(s, sides, slope, sloped, matrix);
    }
  }
}

}  // namespace

void add_constraint_hessian(const Problem& problem, const Constraint& constraint,
                            const LinearisedLaw& linear, std::vector<double>& memory,
                            BlockMatrix& matrix) {
  if (linear.is_zero) return;
  dispatch_rows(constraint.rows, [&](auto rows) {
    add_slope_of<rows()>(problem, constraint, linear.hessian.data(), memory, matrix);
  });
}

}  // namespace ziggurat::dynamics
