#pragma once

#include <cstddef>

namespace roadbook {

// Products of small blocks, stored column by column as in Eigen. Bundle adjustment spends most of
// its time here. Sums run in the order of the inner index, so that any machine gives the same bits.

/// Update of some columns j of a factor L of 6x6 blocks by the columns k of a supernode, which have
/// the same rows: block (i, j) -= the sum of L_ik L_jk^T over k, for the rows i from j on.
struct PanelUpdate {
  const double* const* source;  ///< by column k: where its block of row 0 of the panel would be
  std::size_t width;            ///< number of columns k
  std::size_t first;            ///< first row of the panel that is a column j
  std::size_t targets;          ///< rows from `first` on that are columns j
  std::size_t count;            ///< rows from `first` on
  const std::size_t* place;     ///< of each of them: its row in the panel of the targets
  double* const* target;        ///< by column of that panel: where its block of row 0 would be
};
void subtract_panel(const PanelUpdate& update);

/// Of a block Z_ik of a symmetric matrix: sum_i += Z_ik l_k, and sum_k += Z_ik^T l_i, for rows l_i
/// and l_k of `width` blocks, one behind the other. On the diagonal (`l_i` null) the first alone.
struct SymmetricProduct {
  const double* Z;
  const double* l_i;
  const double* l_k;
  std::size_t width;
  double* sum_i;
  double* sum_k;
};
void add_symmetric(const SymmetricProduct& product);

/// C -= A B^T for 6x3 blocks A and B.
void subtract_outer_63(const double* A, const double* B, double* C);

/// C -= A B, and C -= A^T B, for a 6x6 block A and six rows of `columns` values each, stored row by
/// row.
void subtract_product(const double* A, const double* B, std::size_t columns, double* C);
void subtract_transposed_product(const double* A, const double* B, std::size_t columns, double* C);

}  // namespace roadbook
