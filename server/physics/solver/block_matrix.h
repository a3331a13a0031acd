// SPDX-License-Identifier: MIT
#pragma once
// A square matrix of blocks, one row and column of blocks per tree of an island, with a symmetric
// pattern and unsymmetric values; factored directly. The order of elimination is by least degree
// (A. George, J. W. H. Liu, SIAM Review 31, 1989), ties to the lower index, so that it depends on
// the island alone.

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace ziggurat::dynamics {

class BlockMatrix {
 public:
  /// Sets the pattern and chooses the order.
  /// @param sizes      rows of each block
  /// @param couplings  pairs of blocks that meet off the diagonal
  void shape(std::span<const int> sizes, std::span<const std::pair<int, int>> couplings);

  /// Multiplications that factor() takes, about. The entries have no memory yet: see clear().
  double work() const { return work_; }
  std::size_t count() const { return sizes_.size(); }
  int size(int i) const { return sizes_[i]; }
  int offset(int i) const { return offsets_[i]; }  ///< of a block's first row in a vector
  int rows() const { return rows_; }

  /// Takes memory for the entries, as far as there is none, and makes them 0.
  void clear();
  /// A block's entries, row by row. It must be in the pattern.
  double* block(int i, int j) { return values_.data() + index_[i * count() + j]; }

  /// Replaces the values by their factors L U.
  /// @return  false if a pivot vanishes
  bool factor();
  /// x := matrix^-1 x with the factors.
  void solve(double* x) const;

 private:
  void eliminate_symbolically(std::vector<std::uint64_t>& pattern);
  const double* at(int i, int j) const { return values_.data() + index_[i * count() + j]; }

  std::vector<int> sizes_, offsets_, order_;
  std::vector<int> first_later_, later_;  // of each step: the blocks coupled to it, not yet done
  std::vector<int> index_;                // of each pair into values_, or -1
  std::vector<double> values_;
  std::vector<std::uint64_t> pattern_;
  std::vector<int> degree_;
  int rows_ = 0;
  std::size_t entries_ = 0;
  double work_ = 0;
};

}  // namespace ziggurat::dynamics
