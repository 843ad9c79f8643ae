#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <utility>
#include <vector>

#include "base/se3.hpp"

namespace roadbook {

// Sparse Cholesky factorisation of symmetric positive definite matrices made of 6x6 blocks: the
// normal equations of poses. The same bits on any number of threads, and the sparse inverse from
// the same factor.
//
// Unknown `i` stands at `position(i)` of an elimination order that keeps the factor sparse
// (approximate minimum degree). Matrix, factor and inverse share one storage: the factor's pattern.
class BlockCholesky {
 public:
  /// `pairs`: the blocks off the diagonal that may differ from zero, in either order, repeats
  /// allowed.
  BlockCholesky(std::size_t size, const std::vector<std::pair<int, int>>& pairs);

  [[nodiscard]] std::size_t size() const { return position_.size(); }
  [[nodiscard]] int position(int unknown) const {
    return position_[static_cast<std::size_t>(unknown)];
  }
  /// Blocks in the lower triangle of the factor.
  [[nodiscard]] std::size_t block_count() const { return rows_.size(); }

  /// Where column `position` stands in the storage: its first block is the diagonal's, rows ascend.
  struct Column {
    const int* rows;
    Matrix6d* blocks;
    std::size_t count;
  };
  [[nodiscard]] Column column(int position);

  void set_zero();
  /// Block of two unknowns, row at or below column: `transposed` tells that it holds (b, a).
  [[nodiscard]] Matrix6d& block(int a, int b, bool& transposed);
  /// Adds `value` to block (a, b), and to (b, a) its transpose.
  void add(int a, int b, const Matrix6d& value);

  /// Replaces the matrix by its factor; false if it is not positive definite.
  bool factor(int num_threads);
  /// Solves in place, by unknowns in the caller's numbering, six rows each. After `factor`.
  void solve(Eigen::VectorXd& x) const;
  /// The same for many right-hand sides at once, one a column.
  using Panel = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  void solve(Panel& x, int num_threads) const;
  /// Diagonal blocks of the inverse, by unknowns, from the sparse inverse (Takahashi et al. 1973).
  /// After `factor`, whose result it replaces: a large map has no room for both.
  [[nodiscard]] std::vector<Matrix6d> inverse_diagonal();

 private:
  void order(const std::vector<std::pair<int, int>>& pairs);
  void analyse(const std::vector<std::pair<int, int>>& pairs);
  bool factor_column(std::size_t j, std::vector<std::size_t>& place);
  void solve_in_order(Panel& y) const;

  struct RowEntry {
    int column;
    std::size_t index;  ///< of the block in the storage
  };
  std::vector<int> position_;
  std::vector<std::size_t> begin_;  ///< of each column in rows_ and blocks_; one more at the end
  std::vector<int> rows_;
  std::vector<Matrix6d> blocks_;
  std::vector<std::size_t> row_begin_;
  std::vector<RowEntry> row_entries_;  ///< blocks left of the diagonal, row by row
};

}  // namespace roadbook
