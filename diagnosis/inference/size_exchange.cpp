#include "diagnosis/inference/size_exchange.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace roadbook {

SizeExchange::SizeExchange(std::size_t drives, const Eigen::VectorXd& tau)
    : loose_(0.01 * tau.cwiseAbs2().cwiseInverse()),
      information_(drives, Eigen::MatrixXd::Zero(tau.size(), tau.size())),
      weighted_(drives, Eigen::VectorXd::Zero(tau.size())) {}

SizePrior SizeExchange::others(std::size_t d,
                               const std::vector<Eigen::Index>& own,
                               bool first) const {
  const Eigen::Index count = loose_.size();
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd h = Eigen::VectorXd::Zero(count);
  for (std::size_t other = 0; other < information_.size(); ++other)
    if (other != d) {
      F += information_[other];
      h += weighted_[other];
    }
  if (first) F.diagonal() += loose_;
  std::vector<Eigen::Index> rest;
  for (Eigen::Index k = 0; k < count; ++k)
    if (std::find(own.begin(), own.end(), k) == own.end()) rest.push_back(k);
  SizePrior prior{F(own, own), h(own)};
  if (rest.empty()) return prior;
  Eigen::MatrixXd R = F(rest, rest);
  R.diagonal() += loose_(rest);
  const Eigen::MatrixXd X = R.ldlt().solve(Eigen::MatrixXd(F(rest, own)));
  prior.information -= F(own, rest) * X;
  prior.weighted -= X.transpose() * h(rest);
  return prior;
}

void SizeExchange::hear(std::size_t d,
                        const std::vector<Eigen::Index>& own,
                        const Eigen::MatrixXd& information,
                        const Eigen::VectorXd& x,
                        const SizePrior& prior) {
  information_[d](own, own) = information;
  // At the optimum of both, the drive's own score is what the others pull against.
  weighted_[d](own) = information * x - prior.score(x);
}

Eigen::MatrixXd SizeExchange::information() const {
  Eigen::MatrixXd F = information_.front();
  for (std::size_t d = 1; d < information_.size(); ++d) F += information_[d];
  return F;
}

Eigen::VectorXd SizeExchange::sizes() const {
  Eigen::VectorXd h = weighted_.front();
  for (std::size_t d = 1; d < weighted_.size(); ++d) h += weighted_[d];
  Eigen::MatrixXd F = information();
  F.diagonal() *= 1.0 + 1e-10;
  return h.size() > 0 ? Eigen::VectorXd(F.ldlt().solve(h)) : h;
}

}  // namespace roadbook
