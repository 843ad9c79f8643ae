#pragma once

#include <cstddef>

namespace roadbook {

// Products of small blocks, stored column by column as in Eigen. Bundle adjustment spends most of
// its time here. Sums run in the order of the inner index, so that any machine gives the same bits.

/// Update of column j by an earlier column k of a factor L of 6x6 blocks: block (i, j) -= L_ik
/// L_jk^T.
struct ColumnUpdate {
  const double* L_jk;        ///< the blocks of column k, from row j on
  const int* rows;           ///< row i of each of these blocks
  std::size_t count;         ///< number of these blocks
  const std::size_t* place;  ///< by row i: index of block (i, j) in `blocks`
  double* blocks;            ///< the blocks of column j
};
void subtract_column(const ColumnUpdate& update);

/// C -= A B^T for 6x3 blocks A and B.
void subtract_outer_63(const double* A, const double* B, double* C);

}  // namespace roadbook
