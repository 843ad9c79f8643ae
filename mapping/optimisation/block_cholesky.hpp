#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <utility>
#include <vector>

#include "base/se3.hpp"

namespace roadbook {

// Sparse Cholesky factorisation of symmetric positive definite matrices of 6x6 blocks, such as the
// normal equations of poses. It gives the same bits on any number of threads. The sparse inverse
// comes from the same factor.
//
// Unknown `i` has position `position(i)` in an elimination order that keeps the factor sparse
// (approximate minimum degree). Matrix, factor and inverse share one storage with the factor's
// sparsity pattern.
class BlockCholesky {
 public:
  /// `size`: number of unknowns (blocks of six rows). `pairs`: the blocks off the diagonal that may
  /// differ from zero, in either order, repeats allowed.
  BlockCholesky(std::size_t size, const std::vector<std::pair<int, int>>& pairs);

  [[nodiscard]] std::size_t size() const { return position_.size(); }
  [[nodiscard]] int position(int unknown) const {
    return position_[static_cast<std::size_t>(unknown)];
  }
  /// Blocks in the lower triangle of the factor.
  [[nodiscard]] std::size_t block_count() const { return rows_.size(); }

  /// A column of the storage: its first block is on the diagonal, its rows ascend.
  struct Column {
    const int* rows;
    Matrix6d* blocks;
    std::size_t count;
  };
  [[nodiscard]] Column column(int position);

  void set_zero();
  /// The stored block of unknowns a and b, which lies on or below the diagonal. `transposed` is set
  /// to true if it holds (b, a).
  [[nodiscard]] Matrix6d& block(int a, int b, bool& transposed);
  /// Adds `value` to block (a, b), and to (b, a) its transpose.
  void add(int a, int b, const Matrix6d& value);

  /// Replaces the matrix by its factor; false if it is not positive definite.
  bool factor(int num_threads);
  /// Solves in place. `x`: six rows for each unknown, in the caller's order. Call `factor` first.
  void solve(Eigen::VectorXd& x) const;
  /// The same for many right-hand sides at once, one in each column.
  using Panel = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  void solve(Panel& x, int num_threads) const;
  /// Returns the diagonal blocks of the inverse, one for each unknown, from the sparse inverse
  /// (Takahashi et al. 1973). Call `factor` first. Overwrites the factor, because the memory does
  /// not hold both for a large map.
  [[nodiscard]] std::vector<Matrix6d> inverse_diagonal(int num_threads);

 private:
  void order(const std::vector<std::pair<int, int>>& pairs);
  void analyse(const std::vector<std::pair<int, int>>& pairs);
  void find_supernodes();
  [[nodiscard]] bool finish_column(std::size_t j);
  void invert_supernode(std::size_t panel, int num_threads);
  [[nodiscard]] std::size_t count(std::size_t j) const { return begin_[j + 1] - begin_[j]; }
  [[nodiscard]] std::size_t end_of(std::size_t supernode) const {
    return supernode + 1 < supernodes_.size() ? supernodes_[supernode + 1] : size();
  }
  void solve_in_order(Panel& y) const;

  // A supernode whose rows from `first_row` on are columns of another one: `targets` of them.
  struct Source {
    std::size_t supernode;
    std::size_t first_row;
    std::size_t targets;
  };
  std::vector<int> position_;
  std::vector<std::size_t> begin_;  ///< of each column in rows_ and blocks_; one more at the end
  std::vector<int> rows_;
  std::vector<Matrix6d> blocks_;
  std::vector<std::size_t> supernodes_;       ///< first column of each
  std::vector<std::vector<Source>> sources_;  ///< of each supernode, ascending
};

}  // namespace roadbook
