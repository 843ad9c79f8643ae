#include "diagnosis/inference/held_out.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace roadbook {
namespace {

using Matrix = Eigen::MatrixXd;

// Products of residual, common and extra columns over the rows of one fold.
struct Fold {
  Matrix test;     ///< rows of the fold
  Matrix embargo;  ///< rows near it
};

// Time of one drive.
struct Span {
  double from = 1e300;
  double to = -1e300;
};

std::vector<Span> spans_of(const Innovations& innovations) {
  std::vector<Span> spans;
  for (const Innovation& i : innovations.of) {
    if (i.drive >= spans.size()) spans.resize(i.drive + 1);
    Span& span = spans[i.drive];
    span.from = std::min(span.from, i.t_s);
    span.to = std::max(span.to, i.t_s);
  }
  return spans;
}

// Two-sided 95 % quantile of Student's t.
double t_quantile(std::size_t freedom) {
  return boost::math::quantile(boost::math::students_t(static_cast<double>(freedom)), 0.975);
}

Eigen::VectorXd solve_sizes(const Matrix& G, Eigen::Index columns) {
  if (columns == 0) return {};
  Matrix F = G.block(1, 1, columns, columns);
  F.diagonal() *= 1.0 + 1e-9;
  F.diagonal().array() += 1e-300;
  return F.ldlt().solve(G.col(0).segment(1, columns));
}

double squares(const Matrix& G, const Eigen::VectorXd& size) {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(1 + size.size());
  weights[0] = 1.0;
  weights.tail(size.size()) = -size;
  return weights.dot(G.topLeftCorner(weights.size(), weights.size()) * weights);
}

std::vector<Fold> folds_of(const Innovations& innovations,
                           const std::vector<std::size_t>& columns,
                           const std::vector<double>& residual_weights,
                           bool local,
                           const HeldOutOptions& options) {
  const std::vector<Span> spans = spans_of(innovations);
  const auto n = static_cast<Eigen::Index>(1 + columns.size());
  std::vector<Fold> folds(options.blocks, {Matrix::Zero(n, n), Matrix::Zero(n, n)});
  Eigen::VectorXd v(n);
  for (std::size_t i = 0; i < innovations.of.size(); ++i) {
    const double* row = innovations.row(i);
    v[0] = 0.0;
    for (std::size_t k = 0; k < residual_weights.size(); ++k) v[0] += residual_weights[k] * row[k];
    Eigen::Index at = 1;
    for (const std::size_t c : columns) v[at++] = row[c];
    const Span& span = spans[innovations.of[i].drive];
    const double t = innovations.of[i].t_s - span.from;
    if (local) {
      const auto piece = static_cast<std::size_t>(t / options.interleave_s);
      folds[piece % options.blocks].test.selfadjointView<Eigen::Lower>().rankUpdate(v);
      continue;
    }
    const double length =
        std::max((span.to - span.from) / static_cast<double>(options.blocks), 1e-6);
    const auto fold = std::min(static_cast<std::size_t>(t / length), options.blocks - 1);
    folds[fold].test.selfadjointView<Eigen::Lower>().rankUpdate(v);
    const double into = t - length * static_cast<double>(fold);
    if (fold > 0 && into < options.embargo_s)
      folds[fold - 1].embargo.selfadjointView<Eigen::Lower>().rankUpdate(v);
    if (fold + 1 < options.blocks && into > length - options.embargo_s)
      folds[fold + 1].embargo.selfadjointView<Eigen::Lower>().rankUpdate(v);
  }
  for (Fold& fold : folds) {
    fold.test = Matrix(fold.test.selfadjointView<Eigen::Lower>());
    fold.embargo = Matrix(fold.embargo.selfadjointView<Eigen::Lower>());
  }
  return folds;
}

// Sum of squares of each fold with the first `columns` sizes fitted to the others.
std::vector<double> predicted_squares(const std::vector<Fold>& folds, Eigen::Index columns) {
  Matrix total = Matrix::Zero(folds.front().test.rows(), folds.front().test.cols());
  for (const Fold& fold : folds) total += fold.test;
  std::vector<double> all;
  for (const Fold& fold : folds)
    all.push_back(squares(fold.test, solve_sizes(total - fold.test - fold.embargo, columns)));
  return all;
}

HeldOutGain gain_between(const std::vector<double>& without,
                         const std::vector<double>& with,
                         std::size_t samples,
                         bool local) {
  HeldOutGain gain;
  gain.interleaved = local;
  const auto n = static_cast<double>(with.size());
  std::vector<double> gains;
  for (std::size_t k = 0; k < with.size(); ++k) {
    gains.push_back(0.5 * (without[k] - with[k]));
    gain.total += gains.back();
  }
  const double mean = gain.total / n;
  double variance = 0.0;
  for (const double g : gains) {
    variance += (g - mean) * (g - mean) / (n - 1.0);
    gain.positive_blocks += (g > 0.0 ? 1.0 : 0.0) / n;
  }
  const double half = t_quantile(gains.size() - 1) * std::sqrt(variance * n);
  gain.low = gain.total - half;
  gain.high = gain.total + half;
  gain.per_sample = gain.total / static_cast<double>(samples);
  return gain;
}

}  // namespace

HeldOutGain held_out_gain(const Innovations& innovations,
                          const std::vector<std::size_t>& common,
                          const std::vector<std::size_t>& extra,
                          const std::vector<double>& residual_weights,
                          bool local,
                          const HeldOutOptions& options) {
  if (innovations.of.empty()) return {.interleaved = local};
  std::vector<std::size_t> columns = common;
  columns.insert(columns.end(), extra.begin(), extra.end());
  const std::vector<Fold> folds = folds_of(innovations, columns, residual_weights, local, options);
  return gain_between(predicted_squares(folds, static_cast<Eigen::Index>(common.size())),
                      predicted_squares(folds, static_cast<Eigen::Index>(columns.size())),
                      innovations.of.size(), local);
}

HeldOutGain held_out_gain(const LinearModel& without,
                          const LinearModel& with,
                          bool local,
                          const HeldOutOptions& options) {
  if (with.innovations.of.empty()) return {.interleaved = local};
  const auto squares_of = [&](const LinearModel& m) {
    return predicted_squares(folds_of(m.innovations, m.columns, {1.0}, local, options),
                             static_cast<Eigen::Index>(m.columns.size()));
  };
  return gain_between(squares_of(without), squares_of(with), with.innovations.of.size(), local);
}

}  // namespace roadbook
