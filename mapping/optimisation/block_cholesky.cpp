#include "mapping/optimisation/block_cholesky.hpp"

#include <Eigen/Cholesky>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <atomic>
#include <memory>
#include <numeric>

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
  for (std::size_t j = 0; j < n; ++j) {
    rows_.push_back(static_cast<int>(j));
    rows_.insert(rows_.end(), below[j].begin(), below[j].end());
  }
  find_supernodes();
  blocks_.assign(rows_.size(), Matrix6d::Zero());
}

// Columns of one supernode follow each other and have the same rows below the last of them.
void BlockCholesky::find_supernodes() {
  constexpr std::size_t kMostColumns = 8;  // more would leave workers waiting
  const std::size_t n = size();
  supernodes_.clear();
  std::vector<std::size_t> supernode_of(n);
  for (std::size_t j = 0; j < n; ++j) {
    const bool goes_on = j > 0 && j - supernodes_.back() < kMostColumns &&
                         count(j - 1) == count(j) + 1 && at(rows_[begin_[j - 1] + 1]) == j;
    if (!goes_on) supernodes_.push_back(j);
    supernode_of[j] = supernodes_.size() - 1;
  }
  sources_.assign(supernodes_.size(), {});
  for (std::size_t k = 0; k < supernodes_.size(); ++k) {
    const std::size_t first = supernodes_[k];
    for (std::size_t row = end_of(k) - first; row < count(first); ++row) {
      auto& sources = sources_[supernode_of[at(rows_[begin_[first] + row])]];
      if (sources.empty() || sources.back().supernode != k) sources.push_back({k, row, 0});
      ++sources.back().targets;
    }
  }
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

namespace {

// Where block `row 0` of each column of a panel would be, if its columns were complete.
struct PanelColumns {
  std::vector<double*> of;
  PanelColumns(Matrix6d* blocks,
               const std::vector<std::size_t>& begin,
               std::size_t first,
               std::size_t end) {
    for (std::size_t j = first; j < end; ++j)
      of.push_back(blocks->data() + 36 * (begin[j] - (j - first)));
  }
};

}  // namespace

// The blocks of column j below its diagonal, and the diagonal, from those of the matrix less what
// the columns before it have to say.
bool BlockCholesky::finish_column(std::size_t j) {
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
  }
  return true;
}

// Left-looking: a supernode takes what all supernodes before it have to say, in ascending order.
bool BlockCholesky::factor(int num_threads) {
  const std::size_t n = size();
  const std::size_t panels = sources_.size();
  const auto workers = static_cast<std::size_t>(n < 64 ? 1 : thread_count(num_threads));
  std::atomic<std::size_t> next{0};
  std::atomic<bool> good{true};
  // Supernodes are handed out in ascending order, so whatever a worker waits for is being worked
  // on.
  const auto done = std::make_unique<std::atomic<int>[]>(panels);
  parallel_for(workers, static_cast<int>(workers), [&](std::size_t) {
    std::vector<std::size_t> row_of(n, 0);  // of the panel, by row of the matrix
    std::vector<std::size_t> place;
    place.reserve(n);
    for (std::size_t panel = next++; panel < panels; panel = next++) {
      const std::size_t first = supernodes_[panel];
      const std::size_t width = end_of(panel) - first;
      const PanelColumns columns(blocks_.data(), begin_, first, end_of(panel));
      for (std::size_t r = 0; r < count(first); ++r) row_of[at(rows_[begin_[first] + r])] = r;
      for (const Source& source : sources_[panel]) {
        if (workers > 1) done[source.supernode].wait(0, std::memory_order_acquire);
        const std::size_t from = supernodes_[source.supernode];
        const std::size_t to = end_of(source.supernode);
        const PanelColumns source_columns(blocks_.data(), begin_, from, to);
        place.clear();
        for (std::size_t r = source.first_row; r < count(from); ++r)
          place.push_back(row_of[at(rows_[begin_[from] + r])]);
        subtract_panel({source_columns.of.data(), to - from, source.first_row, source.targets,
                        place.size(), place.data(), columns.of.data()});
      }
      place.resize(count(first));
      std::iota(place.begin(), place.end(), std::size_t{0});
      for (std::size_t c = 0; c < width && good; ++c) {
        if (c > 0)
          subtract_panel(
              {columns.of.data(), c, c, 1, place.size() - c, place.data() + c, columns.of.data()});
        if (!finish_column(first + c)) good = false;
      }
      if (workers > 1) {
        done[panel].store(1, std::memory_order_release);
        done[panel].notify_all();
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
  const auto columns = static_cast<std::size_t>(y.cols());
  for (std::size_t j = 0; j < size(); ++j) {
    auto y_j = rows(j);
    blocks_[begin_[j]].triangularView<Eigen::Lower>().solveInPlace(y_j);
    for (std::size_t p = begin_[j] + 1; p < begin_[j + 1]; ++p)
      subtract_product(blocks_[p].data(), y_j.data(), columns, rows(at(rows_[p])).data());
  }
  for (std::size_t j = size(); j-- > 0;) {
    auto y_j = rows(j);
    for (std::size_t p = begin_[j] + 1; p < begin_[j + 1]; ++p)
      subtract_transposed_product(blocks_[p].data(), rows(at(rows_[p])).data(), columns,
                                  y_j.data());
    blocks_[begin_[j]].triangularView<Eigen::Lower>().transpose().solveInPlace(y_j);
  }
}

// The columns of supernode J and the rows R below it (Takahashi et al. 1973, by blocks). With
// l = L_RJ L_JJ^-1: Z_RJ = -Z_RR l, and Z_JJ = (L_JJ L_JJ^T)^-1 + l^T Z_RR l. Every block of Z_RR
// lies in the factor's pattern, in columns behind those of J, which hold Z already.
void BlockCholesky::invert_supernode(std::size_t panel, int num_threads) {
  const std::size_t first = supernodes_[panel];
  const std::size_t width = end_of(panel) - first;
  const std::size_t below = count(first) - width;
  const int* const rows = rows_.data() + begin_[first] + width;
  const PanelColumns columns(blocks_.data(), begin_, first, end_of(panel));
  const auto block = [&](std::size_t r, std::size_t c) {
    return Eigen::Map<Matrix6d>(columns.of[c] + 36 * r);
  };
  const auto index = [](std::size_t i) { return static_cast<Eigen::Index>(6 * i); };
  Eigen::MatrixXd L = Eigen::MatrixXd::Zero(index(width), index(width));
  for (std::size_t c = 0; c < width; ++c)
    for (std::size_t r = c; r < width; ++r) L.block<6, 6>(index(r), index(c)) = block(r, c);
  const Eigen::MatrixXd M =
      L.triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(index(width), index(width)));
  using Rows = Eigen::Matrix<double, 6, Eigen::Dynamic>;
  std::vector<Rows> l(below, Rows::Zero(6, index(width)));
  std::vector<Rows> sum = l;  // Z_RR l
  for (std::size_t r = 0; r < below; ++r)
    for (std::size_t c = 0; c < width; ++c)
      l[r].noalias() += block(width + r, c) * M.middleRows<6>(index(c));
  // Each thread has columns of its own.
  const double work = static_cast<double>(below) * static_cast<double>(below * width);
  const auto workers = work < 1e4
                           ? std::size_t{1}
                           : std::min(width, static_cast<std::size_t>(thread_count(num_threads)));
  parallel_for(workers, static_cast<int>(workers), [&](std::size_t worker) {
    const std::size_t begin = width * worker / workers;
    const std::size_t columns_of_worker = width * (worker + 1) / workers - begin;
    const auto at_begin = [&](Rows& row) { return row.data() + 36 * begin; };
    for (std::size_t k = 0; k < below; ++k) {
      std::size_t p = begin_[at(rows[k])];
      for (std::size_t i = k; i < below; ++i) {
        while (rows_[p] != rows[i]) ++p;
        add_symmetric({blocks_[p].data(), i == k ? nullptr : at_begin(l[i]), at_begin(l[k]),
                       columns_of_worker, at_begin(sum[i]), at_begin(sum[k])});
      }
    }
  });
  Eigen::MatrixXd Z_JJ = M.transpose() * M;
  for (std::size_t r = 0; r < below; ++r) Z_JJ.noalias() += l[r].transpose() * sum[r];
  Z_JJ = (0.5 * (Z_JJ + Z_JJ.transpose())).eval();
  for (std::size_t c = 0; c < width; ++c) {
    for (std::size_t r = c; r < width; ++r) block(r, c) = Z_JJ.block<6, 6>(index(r), index(c));
    for (std::size_t r = 0; r < below; ++r) block(width + r, c) = -sum[r].middleCols<6>(index(c));
  }
}

std::vector<Matrix6d> BlockCholesky::inverse_diagonal(int num_threads) {
  for (std::size_t panel = supernodes_.size(); panel-- > 0;) invert_supernode(panel, num_threads);
  std::vector<Matrix6d> diagonal(size());
  for (std::size_t i = 0; i < size(); ++i) diagonal[i] = blocks_[begin_[at(position_[i])]];
  return diagonal;
}

}  // namespace roadbook
