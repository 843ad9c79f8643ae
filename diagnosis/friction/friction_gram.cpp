#include "diagnosis/friction/friction_gram.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace roadbook {

FrictionGram::FrictionGram(const std::vector<FrictionSample>& samples,
                           const PlaceCells& cells,
                           const FrictionMean& mean,
                           Eigen::Index flat,
                           const FrictionNoise& noise)
    : flat_(flat), rows_(static_cast<double>(samples.size())) {
  const auto m = static_cast<Eigen::Index>(cells.centres.size());
  const Eigen::Index p = 1 + mean.cols();
  dense_ = Eigen::MatrixXd::Zero(p, p);
  cross_ = Eigen::MatrixXd::Zero(p, m);
  cells_ = Eigen::MatrixXd::Zero(m, m);
  const ReadingNoise own = reading_noise(samples, noise);
  const double rho = noise.correlation;
  const double fresh = std::sqrt(1.0 - rho * rho);
  Eigen::VectorXd row(p), now(p), last = Eigen::VectorXd::Zero(p);
  double last_weight = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double weight = 1.0 / own.sigma[i];
    now << samples[i].friction, mean.row(static_cast<Eigen::Index>(i)).transpose();
    now *= weight;
    const bool goes_on = own.goes_on[i] && rho != 0.0;
    const double a = goes_on ? 1.0 / fresh : 1.0;
    const double b = goes_on ? -rho / fresh : 0.0;
    row = a * now + b * last;
    dense_.selfadjointView<Eigen::Lower>().rankUpdate(row);
    const auto c = static_cast<Eigen::Index>(cells.of[i]);
    const auto d = static_cast<Eigen::Index>(i > 0 ? cells.of[i - 1] : cells.of[i]);
    const double at_c = a * weight;
    const double at_d = b * last_weight;
    cross_.col(c) += at_c * row;
    cells_(c, c) += at_c * at_c;
    if (goes_on) {
      cross_.col(d) += at_d * row;
      cells_(d, d) += at_d * at_d;
      cells_(c, d) += at_c * at_d;
      cells_(d, c) += at_c * at_d;
    }
    log_scale_ += std::log(own.sigma[i]) + (goes_on ? std::log(fresh) : 0.0);
    last = now;
    last_weight = weight;
  }
  dense_ = Eigen::MatrixXd(dense_.selfadjointView<Eigen::Lower>());
}

FrictionGram::Basis::Basis(const FrictionGram& gram, const Eigen::MatrixXd& basis)
    : columns_(gram.dense_.rows() - 1),
      flat_(gram.flat_),
      rows_(gram.rows_),
      log_scale_(gram.log_scale_) {
  const Eigen::Index p = gram.dense_.rows();
  const Eigen::Index k = basis.cols();
  products_.resize(p + k, p + k);
  products_.topLeftCorner(p, p) = gram.dense_;
  if (k == 0) return;
  products_.topRightCorner(p, k) = gram.cross_ * basis;
  products_.bottomLeftCorner(k, p) = products_.topRightCorner(p, k).transpose();
  products_.bottomRightCorner(k, k) = basis.transpose() * gram.cells_ * basis;
}

FrictionGram::Fit FrictionGram::Basis::fit(double size) const {
  const Eigen::Index n = products_.rows() - 1;
  const Eigen::Index terms = n - columns_;
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(n);
  scale.tail(terms).setConstant(size);
  Eigen::MatrixXd A = scale.asDiagonal() * products_.bottomRightCorner(n, n) * scale.asDiagonal();
  const Eigen::VectorXd b = scale.asDiagonal() * products_.col(0).tail(n);
  // Flat columns get a negligible prior, which avoids singular systems.
  for (Eigen::Index i = 0; i < n; ++i) A(i, i) += i < flat_ ? 1e-9 * (1.0 + A(i, i)) : 1.0;
  const Eigen::LLT<Eigen::MatrixXd> solver(A);
  const Eigen::VectorXd x = solver.solve(b);
  const double squares = std::max(products_(0, 0) - b.dot(x), 1e-12 * rows_);
  const Eigen::MatrixXd L = solver.matrixL();
  double log_volume = 0.0;
  for (Eigen::Index i = flat_; i < n; ++i) log_volume += std::log(L(i, i));
  Fit fit;
  fit.scale = std::sqrt(squares / rows_);
  fit.log_likelihood = -rows_ * std::log(fit.scale) - log_scale_ - log_volume;
  fit.mean = x.head(columns_);
  fit.place = size * x.tail(terms);
  return fit;
}

FrictionGram::Fit FrictionGram::fit(const Eigen::MatrixXd& basis, double size) const {
  return Basis(*this, basis).fit(size);
}

}  // namespace roadbook
