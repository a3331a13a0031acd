// SPDX-License-Identifier: MIT
#include "physics/solver/block_matrix.h"

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <type_traits>
#include <utility>

namespace ziggurat::dynamics {
namespace {

constexpr double least_pivot = 1e-30;

/// C -= A B, with A n x k, B k x m, row by row.
template <int N>
void subtract_product(const double* a, const double* b, double* c) {
  for (int i = 0; i < N; ++i) {
    double row[N];
    for (int j = 0; j < N; ++j) row[j] = c[i * N + j];
    for (int k = 0; k < N; ++k) {
      const double factor = a[i * N + k];
      for (int j = 0; j < N; ++j) row[j] -= factor * b[k * N + j];
    }
    for (int j = 0; j < N; ++j) c[i * N + j] = row[j];
  }
}

void subtract_product(const double* a, const double* b, double* c, int n, int inner, int m) {
  if (n == 6 && inner == 6 && m == 6) return subtract_product<6>(a, b, c);
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < inner; ++k) {
      const double factor = a[i * inner + k];
      for (int j = 0; j < m; ++j) c[i * m + j] -= factor * b[k * m + j];
    }
  }
}

/// Calls f with a size as a compile-time constant, or with 0 if it is no usual one.
template <class F>
auto dispatch_size(int size, F f) {
  switch (size) {  // of one body, and of robots with few joints
    case 6:
      return f(std::integral_constant<int, 6>());
    case 8:
      return f(std::integral_constant<int, 8>());
    case 10:
      return f(std::integral_constant<int, 10>());
    default:
      return f(std::integral_constant<int, 0>());
  }
}

/// Eliminates column k of an n x n matrix below its diagonal, two entries at a time.
template <int N, int K>
bool eliminate_column(double* a) {
  constexpr int even = (K + 1) / 2 * 2;
  using Rest = Eigen::Array<double, N - even, 1>;
  const double pivot = a[K * N + K];
  if (!(std::abs(pivot) > least_pivot)) return false;
  const double inverse = 1 / pivot;
  a[K * N + K] = inverse;
  for (int i = K + 1; i < N; ++i) {
    const double ratio = a[i * N + K] * inverse;
    Eigen::Map<Rest>(a + i * N + even) -= ratio * Eigen::Map<const Rest>(a + K * N + even);
    a[i * N + K] = ratio;
  }
  return true;
}

/// A := L U in place, L with ones on its diagonal. The inverses of U's diagonal take its place.
/// Sliding friction makes the matrix unsymmetric, so a pivot may be negative; it must only not be
/// lost in rounding.
template <int N>
bool factor_block(double* a) {
  return [&]<int... K>(std::integer_sequence<int, K...>) {
    return (eliminate_column<N, K>(a) && ...);
  }
  (std::make_integer_sequence<int, N>());
}

/// The same for any size n.
bool factor_block(double* a, int n) {
  for (int k = 0; k < n; ++k) {
    const double pivot = a[k * n + k];
    if (!(std::abs(pivot) > least_pivot)) return false;
    const double inverse = 1 / pivot;
    a[k * n + k] = inverse;
    for (int i = k + 1; i < n; ++i) {
      const double ratio = a[i * n + k] * inverse;
      a[i * n + k] = ratio;
      for (int j = k + 1; j < n; ++j) a[i * n + j] -= ratio * a[k * n + j];
    }
  }
  return true;
}

/// B := L^-1 B, of m columns.
template <int N, int M>
void solve_lower(const double* lu, int rows, double* b, int columns) {
  const int n = N > 0 ? N : rows, m = M > 0 ? M : columns;
  for (int i = 1; i < n; ++i) {
    for (int k = 0; k < i; ++k) {
      const double factor = lu[i * n + k];
      for (int j = 0; j < m; ++j) b[i * m + j] -= factor * b[k * m + j];
    }
  }
}

/// x := U^-1 x.
template <int N>
void solve_upper(const double* lu, int rows, double* x) {
  const int n = N > 0 ? N : rows;
  for (int i = n - 1; i >= 0; --i) {
    double sum = x[i];
    for (int j = i + 1; j < n; ++j) sum -= lu[i * n + j] * x[j];
    x[i] = sum * lu[i * n + i];
  }
}

/// y -= A x.
template <int N>
void subtract_applied(const double* a, const double* x, double* y, int rows, int columns) {
  const int n = N > 0 ? N : rows, m = N > 0 ? N : columns;
  for (int i = 0; i < n; ++i) {
    double sum = y[i];
    for (int j = 0; j < m; ++j) sum -= a[i * m + j] * x[j];
    y[i] = sum;
  }
}

void subtract_applied(const double* a, const double* x, double* y, int rows, int columns) {
  if (rows == 6 && columns == 6) return subtract_applied<6>(a, x, y, 6, 6);
  subtract_applied<0>(a, x, y, rows, columns);
}

/// B := B U^-1, of m rows.
template <int N>
void solve_upper_right(const double* lu, int columns, double* b, int m) {
  const int n = N > 0 ? N : columns;
  for (int r = 0; r < m; ++r) {
    double* row = b + r * n;
    for (int k = 0; k < n; ++k) {
      row[k] *= lu[k * n + k];
      const double factor = row[k];
      for (int j = k + 1; j < n; ++j) row[j] -= factor * lu[k * n + j];
    }
  }
}

}  // namespace

void BlockMatrix::shape(std::span<const int> sizes,
                        std::span<const std::pair<int, int>> couplings) {
  const int n = static_cast<int>(sizes.size());
  sizes_.assign(sizes.begin(), sizes.end());
  offsets_.resize(n);
  rows_ = 0;
  for (int i = 0; i < n; ++i) {
    offsets_[i] = rows_;
    rows_ += sizes_[i];
  }
  const int words = (n + 63) / 64;
  pattern_.assign(static_cast<std::size_t>(n) * words, 0);
  for (const auto& [i, j] : couplings) {
    if (i == j) continue;
    pattern_[i * words + j / 64] |= std::uint64_t{1} << (j % 64);
    pattern_[j * words + i / 64] |= std::uint64_t{1} << (i % 64);
  }
  index_.assign(static_cast<std::size_t>(n) * n, -1);
  eliminate_symbolically(pattern_);
  entries_ = 0;
  const auto add = [&](int i, int j) {
    index_[i * n + j] = static_cast<int>(entries_);
    entries_ += static_cast<std::size_t>(sizes_[i]) * sizes_[j];
  };
  work_ = 0;
  for (int step = 0; step < n; ++step) {
    const int k = order_[step];
    add(k, k);
    double later = 0;
    for (int e = first_later_[step]; e < first_later_[step + 1]; ++e) {
      add(later_[e], k);
      add(k, later_[e]);
      later += sizes_[later_[e]];
    }
    const double size = sizes_[k];
    work_ += size * (size * size / 3 + size * later + later * later);
  }
}

void BlockMatrix::eliminate_symbolically(std::vector<std::uint64_t>& pattern) {
  const int n = static_cast<int>(sizes_.size());
  const int words = (n + 63) / 64;
  order_.clear();
  later_.clear();
  first_later_.assign(1, 0);
  degree_.resize(n);
  const auto count_degree = [&](int i) {
    int degree = 0;
    for (int w = 0; w < words; ++w) degree += std::popcount(pattern[i * words + w]);
    return degree;
  };
  for (int i = 0; i < n; ++i) degree_[i] = count_degree(i);
  for (int step = 0; step < n; ++step) {
    int best = -1;
    for (int i = 0; i < n; ++i) {
      if (degree_[i] >= 0 && (best < 0 || degree_[i] < degree_[best])) best = i;
    }
    order_.push_back(best);
    degree_[best] = -1;
    const std::size_t begin = later_.size();
    for (int w = 0; w < words; ++w) {
      for (std::uint64_t bits = pattern[best * words + w]; bits; bits &= bits - 1) {
        later_.push_back(w * 64 + std::countr_zero(bits));
      }
    }
    first_later_.push_back(static_cast<int>(later_.size()));
    for (std::size_t e = begin; e < later_.size(); ++e) {
      const int i = later_[e];
      for (int w = 0; w < words; ++w) pattern[i * words + w] |= pattern[best * words + w];
      pattern[i * words + i / 64] &= ~(std::uint64_t{1} << (i % 64));
      pattern[i * words + best / 64] &= ~(std::uint64_t{1} << (best % 64));
      degree_[i] = count_degree(i);
    }
  }
}

void BlockMatrix::clear() { values_.assign(entries_, 0.0); }

bool BlockMatrix::factor() {
  const int n = static_cast<int>(count());
  for (int step = 0; step < n; ++step) {
    const int k = order_[step], size = sizes_[k];
    double* pivot = block(k, k);
    const bool regular = dispatch_size(size, [&](auto n) {
      if constexpr (n() > 0) return factor_block<n()>(pivot);
      return factor_block(pivot, size);
    });
    if (!regular) return false;
    const int begin = first_later_[step], end = first_later_[step + 1];
    for (int e = begin; e < end; ++e) {
      const int i = later_[e];
      if (size == 6 && sizes_[i] == 6) {
        solve_upper_right<6>(pivot, 6, block(i, k), 6);
        solve_lower<6, 6>(pivot, 6, block(k, i), 6);
      } else {
        solve_upper_right<0>(pivot, size, block(i, k), sizes_[i]);
        solve_lower<0, 0>(pivot, size, block(k, i), sizes_[i]);
      }
    }
    for (int e = begin; e < end; ++e) {
      for (int f = begin; f < end; ++f) {
        const int i = later_[e], j = later_[f];
        subtract_product(block(i, k), block(k, j), block(i, j), sizes_[i], size, sizes_[j]);
      }
    }
  }
  return true;
}

void BlockMatrix::solve(double* x) const {
  const int n = static_cast<int>(count());
  for (int step = 0; step < n; ++step) {
    const int k = order_[step], size = sizes_[k];
    double* part = x + offsets_[k];
    dispatch_size(size, [&](auto n) { solve_lower<n(), 1>(at(k, k), size, part, 1); });
    for (int e = first_later_[step]; e < first_later_[step + 1]; ++e) {
      const int i = later_[e];
      subtract_applied(at(i, k), part, x + offsets_[i], sizes_[i], size);
    }
  }
  for (int step = n - 1; step >= 0; --step) {
    const int k = order_[step], size = sizes_[k];
    double* part = x + offsets_[k];
    for (int e = first_later_[step]; e < first_later_[step + 1]; ++e) {
      const int i = later_[e];
      subtract_applied(at(k, i), x + offsets_[i], part, size, sizes_[i]);
    }
    dispatch_size(size, [&](auto n) { solve_upper<n()>(at(k, k), size, part); });
  }
}

}  // namespace ziggurat::dynamics
