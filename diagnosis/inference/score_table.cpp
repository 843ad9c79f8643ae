#include "diagnosis/inference/score_table.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.hpp"
#include "diagnosis/numerics/block_scatter.hpp"

namespace roadbook {
namespace {

Eigen::Index signed_index(std::size_t i) { return static_cast<Eigen::Index>(i); }

// Solves A x = b for symmetric A >= 0, leaving directions without information at 0.
Eigen::MatrixXd pseudo_solve(const Eigen::MatrixXd& A, const Eigen::MatrixXd& b) {
  if (A.rows() == 0) return Eigen::MatrixXd::Zero(0, b.cols());
  const Eigen::VectorXd scale = A.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * A * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  Eigen::VectorXd inverse = eigen.eigenvalues();
  for (double& v : inverse) v = v > 1e-9 ? 1.0 / v : 0.0;
  return scale.asDiagonal() * (eigen.eigenvectors() * inverse.asDiagonal() *
                               (eigen.eigenvectors().transpose() * (scale.asDiagonal() * b)));
}

// Column i of a candidate among the sides of a pass.
Eigen::Index side_of(const Candidate& c, Eigen::Index i) {
  return 1 + signed_index(c.columns[static_cast<std::size_t>(i)]);
}

Eigen::MatrixXd gathered(const Eigen::MatrixXd& cross, const Candidate& c) {
  Eigen::MatrixXd block(cross.rows(), signed_index(c.columns.size()));
  for (Eigen::Index i = 0; i < block.cols(); ++i) block.col(i) = cross.col(side_of(c, i));
  return block;
}

template <typename Part>
double squares_of_seconds(const Innovations& in, const Part& part) {
  std::vector<BlockPart> parts(in.of.size());
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i] = {in.of[i].t_s, part(i), 0.0};
  return squares_of_blocks(std::move(parts), 1.0);
}

}  // namespace

double log_evidence(const Eigen::VectorXd& score, const Eigen::MatrixXd& information, double tau) {
  const Eigen::Index n = score.size();
  const Eigen::MatrixXd kappa = tau * tau * information + Eigen::MatrixXd::Identity(n, n);
  const Eigen::LDLT<Eigen::MatrixXd> solver(kappa);
  const double fit = 0.5 * tau * tau * score.dot(solver.solve(score));
  return fit - 0.5 * solver.vectorD().array().max(1e-300).log().sum();
}

double chi_squared_tail(double statistic, int freedom) {
  if (statistic <= 0.0) return 1.0;
  // Recurrence from one or two degrees of freedom upwards (Abramowitz and Stegun 26.4.21).
  const double half = 0.5 * statistic;
  double tail = freedom % 2 == 1 ? std::erfc(std::sqrt(half)) : std::exp(-half);
  double term =
      freedom % 2 == 1 ? std::sqrt(half / M_PI) * 2.0 * std::exp(-half) : half * std::exp(-half);
  for (int k = freedom % 2 == 1 ? 1 : 2; k < freedom; k += 2) {
    tail += term;
    term *= statistic / (k + 2.0);
  }
  return tail;
}

ScoreTable::ScoreTable(const CauseModel& model, Projection projection)
    : all_(std::move(projection)) {
  sizes_ = Eigen::VectorXd::Zero(signed_index(all_.accepted));
  std::size_t at = 0;
  for (const Accepted& a : model.accepted) {
    const auto n = static_cast<std::size_t>(a.size.size());
    ranges_.emplace_back(at, n);
    sizes_.segment(signed_index(at), a.size.size()) = a.size;
    at += n;
  }
  ROADBOOK_ASSERT(at == all_.accepted);
  multiply();
}

void ScoreTable::multiply() {
  const Innovations& in = all_.innovations;
  const Eigen::Index base = signed_index(1 + all_.accepted);
  const Eigen::Index sides = signed_index(in.sides);
  cross_ = Eigen::MatrixXd::Zero(base, sides);
  Eigen::MatrixXd cross = Eigen::MatrixXd::Zero(sides, base);  // a base's products side by side
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(sides);
  const std::vector<std::pair<std::size_t, std::size_t>> pairs = own_pairs();
  std::vector<double> products(pairs.size(), 0.0);
  for (std::size_t i = 0; i < in.of.size(); ++i) {
    const Eigen::Map<const Eigen::VectorXd> row(in.row(i), sides);
    for (Eigen::Index k = 0; k < base; ++k) cross.col(k) += row[k] * row;
    squares += row.cwiseAbs2();
    for (std::size_t p = 0; p < pairs.size(); ++p)
      products[p] += in.row(i)[pairs[p].first] * in.row(i)[pairs[p].second];
  }
  cross_ = cross.transpose();
  base_ = cross_.leftCols(base);
  std::size_t at = 0;
  for (const Candidate& c : all_.candidates) {
    const auto n = signed_index(c.columns.size());
    Eigen::MatrixXd own(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      own(i, i) = squares[side_of(c, i)];
      for (Eigen::Index j = 0; j < i; ++j) own(i, j) = own(j, i) = products[at++];
    }
    own_.push_back(std::move(own));
  }
}

// Sides of each candidate's columns, two by two, in the order in which they are read again.
std::vector<std::pair<std::size_t, std::size_t>> ScoreTable::own_pairs() const {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const Candidate& c : all_.candidates)
    for (std::size_t i = 0; i < c.columns.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) pairs.emplace_back(1 + c.columns[i], 1 + c.columns[j]);
  return pairs;
}

double ScoreTable::tests() const {
  double count = 0.0;
  bool places = false;
  for (const Candidate& c : all_.candidates) {
    if (c.kind == CandidateKind::kPlace)
      places = true;
    else
      count += 1.0;
  }
  return count + (places ? 1.0 : 0.0);
}

double ScoreTable::names() const {
  return static_cast<double>(
      std::count_if(all_.candidates.begin(), all_.candidates.end(),
                    [](const Candidate& c) { return c.kind == CandidateKind::kNamed; }));
}

std::pair<std::size_t, std::size_t> ScoreTable::accepted_range(std::size_t a) const {
  return ranges_[a];
}

Score ScoreTable::score_of(std::size_t c,
                           const std::vector<Eigen::Index>& nuisance,
                           const Eigen::VectorXd& residual) const {
  const Candidate& candidate = all_.candidates[c];
  const Eigen::MatrixXd block = gathered(cross_, candidate);
  const Eigen::Index n = block.cols();
  Eigen::MatrixXd C(signed_index(nuisance.size()), n);
  Eigen::MatrixXd G(signed_index(nuisance.size()), signed_index(nuisance.size()));
  Eigen::VectorXd y(signed_index(nuisance.size()));
  const Eigen::VectorXd base_residual = base_ * residual;
  for (Eigen::Index i = 0; i < C.rows(); ++i) {
    C.row(i) = block.row(nuisance[static_cast<std::size_t>(i)]);
    y[i] = base_residual[nuisance[static_cast<std::size_t>(i)]];
    for (Eigen::Index j = 0; j < G.cols(); ++j)
      G(i, j) = base_(nuisance[static_cast<std::size_t>(i)], nuisance[static_cast<std::size_t>(j)]);
  }
  const Eigen::MatrixXd solved = pseudo_solve(G, C);
  Score score;
  score.information = own_[c] - C.transpose() * solved;
  const Eigen::VectorXd u = block.transpose() * residual - solved.transpose() * y;
  // If the accepted causes already explain a column, only rounding errors remain.
  for (Eigen::Index i = 0; i < n; ++i)
    if (score.information(i, i) < 1e-7 * own_[c](i, i)) {
      score.information.row(i).setZero();
      score.information.col(i).setZero();
    }
  score.size = pseudo_solve(score.information, u);
  score.statistic = std::max(0.0, u.dot(score.size));
  score.freedom = static_cast<int>(n);
  score.p = chi_squared_tail(score.statistic, score.freedom);
  score.evidence = log_evidence(score.information * score.size, score.information, candidate.tau) -
                   candidate.penalty - std::log(tests());
  return score;
}

Score ScoreTable::score(std::size_t c) const {
  std::vector<Eigen::Index> nuisance;
  for (std::size_t i = 0; i < all_.accepted; ++i) nuisance.push_back(signed_index(1 + i));
  return score_of(c, nuisance, Eigen::VectorXd::Unit(signed_index(1 + all_.accepted), 0));
}

Score ScoreTable::score_without(std::size_t c, std::size_t without) const {
  return score_without(c, std::vector<std::size_t>{without});
}

Score ScoreTable::score_without(std::size_t c, const std::vector<std::size_t>& without) const {
  const std::vector<Eigen::Index> left_out = columns_of(without);
  Eigen::VectorXd residual = Eigen::VectorXd::Unit(signed_index(1 + all_.accepted), 0);
  std::vector<Eigen::Index> nuisance;
  for (Eigen::Index i = 0; i < signed_index(all_.accepted); ++i) {
    if (std::find(left_out.begin(), left_out.end(), i) == left_out.end())
      nuisance.push_back(1 + i);
    else
      residual[1 + i] = sizes_[i];
  }
  return score_of(c, nuisance, residual);
}

double ScoreTable::loss_without(std::size_t a) const {
  return loss_without(std::vector<std::size_t>{a});
}

double ScoreTable::loss_without(const std::vector<std::size_t>& causes) const {
  const Eigen::Index rows = signed_index(all_.accepted);
  const Eigen::MatrixXd F = base_.bottomRightCorner(rows, rows);
  // Information of the sizes of `causes`, with the other sizes free: inverse of that block of the
  // covariance.
  const Eigen::MatrixXd covariance = pseudo_solve(F, Eigen::MatrixXd::Identity(rows, rows));
  const std::vector<Eigen::Index> own = columns_of(causes);
  const Eigen::VectorXd size = sizes_(own);
  return 0.5 * size.dot(pseudo_solve(covariance(own, own), size).col(0));
}

std::vector<Eigen::Index> ScoreTable::columns_of(const std::vector<std::size_t>& causes) const {
  std::vector<Eigen::Index> columns;
  for (const std::size_t a : causes)
    for (std::size_t i = 0; i < ranges_[a].second; ++i)
      columns.push_back(signed_index(ranges_[a].first + i));
  return columns;
}

double ScoreTable::made_up(std::size_t c, std::size_t a) const {
  const Eigen::Index row = 1 + signed_index(ranges_[a].first);
  const Eigen::VectorXd with = gathered(cross_, all_.candidates[c]).row(row).transpose();
  const double squares = base_(row, row);
  return squares > 0.0 ? with.dot(pseudo_solve(own_[c], with).col(0)) / squares : 0.0;
}

double ScoreTable::robust_statistic(std::size_t c) const {
  const Score s = score(c);
  const Candidate& candidate = all_.candidates[c];
  const Eigen::Index n = signed_index(all_.accepted);
  const Eigen::MatrixXd F = base_.bottomRightCorner(n, n);
  const Eigen::MatrixXd C = gathered(cross_, candidate).bottomRows(n);
  const Eigen::VectorXd nuisance = pseudo_solve(F, C * s.size).col(0);
  const Eigen::VectorXd taken = pseudo_solve(F, base_.col(0).tail(n)).col(0);
  double sum = 0.0;
  const double squares = squares_of_seconds(all_.innovations, [&](std::size_t i) {
    const double* row = all_.innovations.row(i);
    const Eigen::Map<const Eigen::VectorXd> a(row + 1, n);
    double direction = -a.dot(nuisance);
    for (Eigen::Index k = 0; k < s.size.size(); ++k)
      direction += row[side_of(candidate, k)] * s.size[k];
    const double e = row[0] - a.dot(taken);
    sum += direction * e;
    return direction * (e - direction);  // residual after the fit of the candidate
  });
  return squares > 0.0 ? sum * sum / squares : 0.0;
}

double ScoreTable::block_scatter(std::size_t a) const {
  const Eigen::Index n = signed_index(all_.accepted);
  // The fitted size moves by weights * columns * residual.
  const Eigen::VectorXd weights =
      pseudo_solve(base_.bottomRightCorner(n, n),
                   Eigen::MatrixXd::Identity(n, n).col(signed_index(ranges_[a].first)))
          .col(0);
  double rows = 0.0;
  const double blocks = squares_of_seconds(all_.innovations, [&](std::size_t i) {
    const double* row = all_.innovations.row(i);
    const double moves = weights.dot(Eigen::Map<const Eigen::VectorXd>(row + 1, n));
    rows += moves * moves;
    return moves * row[0];
  });
  return rows > 0.0 ? std::sqrt(blocks / rows) : 1.0;
}

}  // namespace roadbook
