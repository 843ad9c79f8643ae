#include <Eigen/SparseCholesky>

#include "base/error.hpp"
#include "speedmap/presence/presence_map.hpp"

namespace roadbook {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// Diagonal of (L L^T)^-1. Z, the inverse, has entries Z_ij for all (i, j) of L's pattern; from the
/// last column to the first,
///   Z_ij = -1 / L_jj sum_(k > j) Z_ik L_kj  (i > j),  Z_jj = 1 / L_jj (1 / L_jj - sum_k L_kj Z_kj)
/// where all Z_ik that are asked for lie in the pattern again.
Eigen::VectorXd inverse_diagonal(const Sparse& L) {
  const Eigen::Index n = L.cols();
  const auto* const begin = L.outerIndexPtr();
  const auto* const row = L.innerIndexPtr();
  const double* const value = L.valuePtr();
  std::vector<double> Z(static_cast<std::size_t>(L.nonZeros()), 0.0);
  std::vector<double> column(static_cast<std::size_t>(n), 0.0);  // L_kj of the column at work
  std::vector<double> sum(static_cast<std::size_t>(n), 0.0);
  std::vector<bool> in(static_cast<std::size_t>(n), false);
  Eigen::VectorXd diagonal(n);
  const auto at = [](auto index) { return static_cast<std::size_t>(index); };
  for (Eigen::Index j = n - 1; j >= 0; --j) {
    const auto first = begin[j];
    const auto last = begin[j + 1];
    const double pivot = value[first];  // rows ascend: the diagonal is first
    for (auto p = first + 1; p < last; ++p) {
      column[at(row[p])] = value[p];
      sum[at(row[p])] = 0.0;
      in[at(row[p])] = true;
    }
    for (auto p = first + 1; p < last; ++p) {
      const auto k = row[p];
      const double L_kj = value[p];
      double own = 0.0;
      for (auto q = begin[k]; q < begin[k + 1]; ++q) {
        const auto i = row[q];
        if (!in[at(i)]) continue;
        const double Z_ik = Z[at(q)];
        sum[at(i)] += Z_ik * L_kj;
        if (i != k) own += Z_ik * column[at(i)];
      }
      sum[at(k)] += own;
    }
    double rest = 0.0;
    for (auto p = first + 1; p < last; ++p) {
      Z[at(p)] = -sum[at(row[p])] / pivot;
      rest += value[p] * Z[at(p)];
      in[at(row[p])] = false;
    }
    Z[at(first)] = (1.0 / pivot - rest) / pivot;
    diagonal[j] = Z[at(first)];
  }
  return diagonal;
}

}  // namespace

Eigen::VectorXd PresenceMap::variances() const {
  const Eigen::SimplicialLLT<Sparse> cholesky(matrix());
  ROADBOOK_ASSERT(cholesky.info() == Eigen::Success);
  const Sparse L = cholesky.matrixL();
  const Eigen::VectorXd permuted = inverse_diagonal(L);
  Eigen::VectorXd result(permuted.size());
  const auto& position = cholesky.permutationP().indices();  // node i is at position[i]
  for (Eigen::Index i = 0; i < result.size(); ++i) result[i] = permuted[position[i]];
  return result;
}

}  // namespace roadbook
