#include "mapping/optimisation/block_cholesky.hpp"

#include <Eigen/Cholesky>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <atomic>
#include <memory>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/parallel.hpp"
#include "mapping/optimisation/block_products.hpp"

namespace roadbook {
BlockCholesky::BlockCholesky(std::size_t size, const std::vector<std::pair<int, int>>& pairs)
    : position_(size) {
  order(pairs);
  analyse(pairs);
}

void BlockCholesky::order(const std::vector<std::pair<int, int>>& pairs) {
  const auto n = static_cast<int>(size());
  if (n == 0) return;
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(2 * pairs.size() + size());
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, 1.0);
  for (const auto& [a, b] : pairs) {
    ROADBOOK_ASSERT(a >= 0 && b >= 0 && a < n && b < n);
    if (a == b) continue;
    entries.emplace_back(a, b, 1.0);
    entries.emplace_back(b, a, 1.0);
  }
  Eigen::SparseMatrix<double> pattern(n, n);
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> unknown_at;
  Eigen::AMDOrdering<int>()(pattern, unknown_at);
  for (int k = 0; k < n; ++k) position_[at(unknown_at.indices()[k])] = k;
}

// The pattern of column j of the factor is that of the matrix joined with those of its children in
// the elimination tree (the columns whose first block below the diagonal is in row j).
void BlockCholesky::analyse(const std::vector<std::pair<int, int>>& pairs) {
  const std::size_t n = size();
  std::vector<std::vector<int>> below(n);
  for (const auto& [a, b] : pairs) {
    if (a == b) continue;
    below[at(std::min(position(a), position(b)))].push_back(std::max(position(a), position(b)));
  }
  std::vector<std::vector<int>> children(n);
  begin_.assign(n + 1, 0);
  for (std::size_t j = 0; j < n; ++j) {
    std::vector<int>& rows = below[j];
    for (const int child : children[j])
      for (const int row : below[at(child)])
        if (at(row) != j) rows.push_back(row);
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    if (!rows.empty()) children[at(rows.front())].push_back(static_cast<int>(j));
    begin_[j + 1] = begin_[j] + rows.size() + 1;
  }
  rows_.reserve(begin_[n]);
  row_begin_.assign(n + 1, 0);
  for (std::size_t j = 0; j < n; ++j) {
    rows_.push_back(static_cast<int>(j));
    rows_.insert(rows_.end(), below[j].begin(), below[j].end());
    for (const int row : below[j]) ++row_begin_[at(row) + 1];
  }
  for (std::size_t j = 0; j < n; ++j) row_begin_[j + 1] += row_begin_[j];
  row_entries_.resize(row_begin_[n]);
  std::vector<std::size_t> next(row_begin_.begin(), row_begin_.end() - 1);
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t p = begin_[j] + 1; p < begin_[j + 1]; ++p)
      row_entries_[next[at(rows_[p])]++] = {static_cast<int>(j), p};
  blocks_.assign(rows_.size(), Matrix6d::Zero());
}

BlockCholesky::Column BlockCholesky::column(int position) {
  const std::size_t first = begin_[at(position)];
  return {rows_.data() + first, blocks_.data() + first, begin_[at(position) + 1] - first};
}

void BlockCholesky::set_zero() { std::fill(blocks_.begin(), blocks_.end(), Matrix6d::Zero()); }

Matrix6d& BlockCholesky::block(int a, int b, bool& transposed) {
  const int row = std::max(position(a), position(b));
  const int col = std::min(position(a), position(b));
  transposed = position(a) < position(b);
  const auto first = rows_.begin() + static_cast<std::ptrdiff_t>(begin_[at(col)]);
  const auto last = rows_.begin() + static_cast<std::ptrdiff_t>(begin_[at(col) + 1]);
  const auto found = std::lower_bound(first, last, row);
  ROADBOOK_ASSERT(found != last && *found == row);
  return blocks_[static_cast<std::size_t>(found - rows_.begin())];
}

void BlockCholesky::add(int a, int b, const Matrix6d& value) {
  bool transposed = false;
  Matrix6d& target = block(a, b, transposed);
  if (transposed)
    target += value.transpose();
  else
    target += value;
}

// Left-looking: column j takes what all columns before it have to say, in ascending order.
bool BlockCholesky::factor_column(std::size_t j, std::vector<std::size_t>& place) {
  Matrix6d& diagonal = blocks_[begin_[j]];
  const Eigen::LLT<Matrix6d> llt(diagonal);
  if (llt.info() != Eigen::Success || !diagonal.allFinite()) return false;
  diagonal = llt.matrixL();
  // L_ij = A_ij * L_jj^-T: one inverse, then products.
  const Matrix6d inverse =
      diagonal.triangularView<Eigen::Lower>().solve(Matrix6d::Identity()).transpose();
  for (std::size_t p = begin_[j] + 1; p < begin_[j + 1]; ++p) {
    const Matrix6d a = blocks_[p];
    blocks_[p].noalias() = a * inverse;
    place[at(rows_[p])] = p;
  }
  return true;
}

bool BlockCholesky::factor(int num_threads) {
  const std::size_t n = size();
  const auto workers = static_cast<std::size_t>(n < 64 ? 1 : thread_count(num_threads));
  std::atomic<std::size_t> next{0};
  std::atomic<bool> good{true};
  // Columns are handed out in ascending order, so whatever a worker waits for is being worked on.
  const auto done = std::make_unique<std::atomic<int>[]>(n);
  parallel_for(workers, static_cast<int>(workers), [&](std::size_t) {
    std::vector<std::size_t> place(n, 0);
    for (std::size_t j = next++; j < n; j = next++) {
      for (std::size_t p = begin_[j]; p < begin_[j + 1]; ++p) place[at(rows_[p])] = p;
      for (std::size_t e = row_begin_[j]; e < row_begin_[j + 1]; ++e) {
        const auto [k, index] = row_entries_[e];
        if (workers > 1) done[at(k)].wait(0, std::memory_order_acquire);
        subtract_column({blocks_[index].data(), rows_.data() + index, begin_[at(k) + 1] - index,
                         place.data(), blocks_.front().data()});
      }
      if (good && !factor_column(j, place)) good = false;
      if (workers > 1) {
        done[j].store(1, std::memory_order_release);
        done[j].notify_all();
      }
    }
  });
  return good;
}

void BlockCholesky::solve(Eigen::VectorXd& x) const {
  const std::size_t n = size();
  ROADBOOK_ASSERT(x.size() == static_cast<Eigen::Index>(6 * n));
  const auto segment = [](auto& v, std::size_t i) {
    return v.template segment<6>(static_cast<Eigen::Index>(6 * i));
  };
  Eigen::VectorXd y(x.size());
  for (std::size_t i = 0; i < n; ++i) segment(y, at(position_[i])) = segment(x, i);
  for (std::size_t j = 0; j < n; ++j) {
    const Vector6d y_j =
        blocks_[begin_[j]].triangularView<Eigen::Lower>().solve(Vector6d(segment(y, j)));
    segment(y, j) = y_j;
    for (std::size_t p = begin_[j] + 1; p < begin_[j + 1]; ++p)
      segment(y, at(rows_[p])).noalias() -= blocks_[p] * y_j;
  }
  for (std::size_t j = n; j-- > 0;) {
    Vector6d y_j = segment(y, j);
    for (std::size_t p = begin_[j] + 1; p < begin_[j + 1]; ++p)
      y_j.noalias() -= blocks_[p].transpose() * Vector6d(segment(y, at(rows_[p])));
    blocks_[begin_[j]].triangularView<Eigen::Lower>().transpose().solveInPlace(y_j);
    segment(y, j) = y_j;
  }
  for (std::size_t i = 0; i < n; ++i) segment(x, i) = segment(y, at(position_[i]));
}

void BlockCholesky::solve(Panel& x, int num_threads) const {
  ROADBOOK_ASSERT(x.rows() == static_cast<Eigen::Index>(6 * size()));
  constexpr Eigen::Index kColumns = 16;  // whatever the threads: sums round by a panel's width
  const Eigen::Index blocks = (x.cols() + kColumns - 1) / kColumns;
  parallel_for(static_cast<std::size_t>(blocks), num_threads, [&](std::size_t block) {
    const Eigen::Index first = kColumns * static_cast<Eigen::Index>(block);
    const Eigen::Index count = std::min(kColumns, x.cols() - first);
    const auto of_unknown = [&](std::size_t i) {
      return x.block(static_cast<Eigen::Index>(6 * i), first, 6, count);
    };
    const auto ordered = [&](Panel& y, std::size_t i) {
      return y.middleRows<6>(static_cast<Eigen::Index>(6 * at(position_[i])));
    };
    Panel y(x.rows(), count);
    for (std::size_t i = 0; i < size(); ++i) ordered(y, i) = of_unknown(i);
    solve_in_order(y);
    for (std::size_t i = 0; i < size(); ++i) of_unknown(i) = ordered(y, i);
  });
}

// Six rows each position.
void BlockCholesky::solve_in_order(Panel& y) const {
  const auto rows = [&](std::size_t j) {
    return y.middleRows<6>(static_cast<Eigen::Index>(6 * j));
  };
  for (std::size_t j = 0; j < size(); ++j) {
    auto y_j = rows(j);
    blocks_[begin_[j]].triangularView<Eigen::Lower>().solveInPlace(y_j);
    for (std::size_t p = begin_[j] + 1; p < begin_[j + 1]; ++p)
      rows(at(rows_[p])) -= blocks_[p].lazyProduct(y_j);
  }
  for (std::size_t j = size(); j-- > 0;) {
    auto y_j = rows(j);
    for (std::size_t p = begin_[j] + 1; p < begin_[j + 1]; ++p)
      y_j -= blocks_[p].transpose().lazyProduct(rows(at(rows_[p])));
    blocks_[begin_[j]].triangularView<Eigen::Lower>().transpose().solveInPlace(y_j);
  }
}

// With unit columns l_kj = L_kj L_jj^-1: Z_ij = -sum_k Z_ik l_kj over the column's own rows, and
// Z_jj = (L_jj L_jj^T)^-1 - sum_k l_kj^T Z_kj. Every Z_ik needed lies in the factor's pattern.
std::vector<Matrix6d> BlockCholesky::inverse_diagonal() {
  const std::size_t n = size();
  std::vector<Matrix6d>& Z = blocks_;  // columns after j hold Z already, the others still L
  std::vector<Matrix6d> l;
  std::vector<Matrix6d> sum;
  for (std::size_t j = n; j-- > 0;) {
    const Matrix6d inverse =
        blocks_[begin_[j]].triangularView<Eigen::Lower>().solve(Matrix6d::Identity());
    const std::size_t first = begin_[j] + 1;
    const std::size_t count = begin_[j + 1] - first;
    l.resize(count);
    for (std::size_t k = 0; k < count; ++k) l[k].noalias() = blocks_[first + k] * inverse;
    sum.assign(count, Matrix6d::Zero());
    for (std::size_t k = 0; k < count; ++k) {
      std::size_t p = begin_[at(rows_[first + k])];
      sum[k].noalias() += Z[p].lazyProduct(l[k]);
      for (std::size_t i = k + 1; i < count; ++i) {
        while (rows_[p] != rows_[first + i]) ++p;
        sum[i].noalias() += Z[p].lazyProduct(l[k]);
        sum[k].noalias() += Z[p].transpose().lazyProduct(l[i]);
      }
    }
    Matrix6d Z_jj = inverse.transpose() * inverse;
    for (std::size_t k = 0; k < count; ++k) {
      Z[first + k] = -sum[k];
      Z_jj.noalias() += l[k].transpose() * sum[k];
    }
    Z[begin_[j]] = 0.5 * (Z_jj + Z_jj.transpose());
  }
  std::vector<Matrix6d> diagonal(n);
  for (std::size_t i = 0; i < n; ++i) diagonal[i] = Z[begin_[at(position_[i])]];
  return diagonal;
}

}  // namespace roadbook
