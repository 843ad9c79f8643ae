#pragma once

#include <cstddef>

namespace roadbook {

// Products of small blocks, column by column as Eigen stores them, which most of the time of bundle
// adjustment goes into. Sums are taken in the order of the inner index: the same bits on any
// machine.

/// Column k of a factor L of 6x6 blocks taken off a later column j: block (i, j) -= L_ik L_jk^T.
struct ColumnUpdate {
  const double* L_jk;  ///< column k from the block of row j on
  const int* rows;     ///< i of each block
  std::size_t count;
  const std::size_t* place;  ///< by row: which of `blocks` is (i, j)
  double* blocks;
};
void subtract_column(const ColumnUpdate& update);

/// C -= A B^T for 6x3 blocks A and B.
void subtract_outer_63(const double* A, const double* B, double* C);

}  // namespace roadbook
