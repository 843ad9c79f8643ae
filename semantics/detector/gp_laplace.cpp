#include "semantics/detector/gp_laplace.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace roadbook {

double logistic(double f) {
  return f >= 0.0 ? 1.0 / (1.0 + std::exp(-f)) : std::exp(f) / (1.0 + std::exp(f));
}

Eigen::MatrixXd lower_gram(const Eigen::MatrixXd& A) {
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(A.rows(), A.rows());
  G.selfadjointView<Eigen::Lower>().rankUpdate(A);
  return G;
}

namespace {

double log_logistic(double f) {
  return f >= 0.0 ? -std::log1p(std::exp(-f)) : f - std::log1p(std::exp(f));
}

struct Slopes {
  Eigen::VectorXd gradient;  ///< of the log likelihood, by f
  Eigen::VectorXd root_W;
};

Slopes slopes_at(const Eigen::VectorXd& y, const Eigen::VectorXd& f) {
  Slopes s{Eigen::VectorXd(f.size()), Eigen::VectorXd(f.size())};
  for (Eigen::Index i = 0; i < f.size(); ++i) {
    const double p = logistic(f[i]);
    s.gradient[i] = 0.5 * (y[i] + 1.0) - p;
    s.root_W[i] = std::sqrt(std::max(p * (1.0 - p), 1e-300));
  }
  return s;
}

double log_likelihood(const Eigen::VectorXd& y, const Eigen::VectorXd& f) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < f.size(); ++i) sum += log_logistic(y[i] * f[i]);
  return sum;
}

// The posterior over the weights, from the normal equations of the features.
class ByFeatures {
 public:
  ByFeatures(const GpExamples& e, const GpPrior& prior) : e_(e), prior_(prior) {}

  [[nodiscard]] Eigen::Index size() const { return e_.X.cols(); }
  [[nodiscard]] Eigen::VectorXd latent(const Eigen::VectorXd& theta) const { return e_.X * theta; }
  [[nodiscard]] double log_prior(const Eigen::VectorXd& theta, const Eigen::VectorXd&) const {
    return -0.5 * theta.cwiseAbs2().cwiseQuotient(prior_.variance).sum();
  }
  [[nodiscard]] Eigen::VectorXd newton_target(const Slopes& s,
                                              const Eigen::VectorXd& f,
                                              Eigen::LLT<Eigen::MatrixXd>& factor) const {
    Eigen::MatrixXd A = lower_gram((s.root_W.asDiagonal() * e_.X).transpose());
    A.diagonal() += prior_.variance.cwiseInverse();
    factor.compute(A);
    return factor.solve(e_.X.transpose() * (s.root_W.cwiseAbs2().cwiseProduct(f) + s.gradient));
  }
  [[nodiscard]] double log_det_offset() const { return prior_.variance.array().log().sum(); }
  [[nodiscard]] Eigen::VectorXd theta(const Eigen::VectorXd& solution) const { return solution; }

 private:
  const GpExamples& e_;
  const GpPrior& prior_;
};

// The same posterior from the equations of the examples (Rasmussen and Williams, algorithm 3.1): f
// = K a. The products of the examples are computed once for all scales.
class ByExamples {
 public:
  ByExamples(const GpExamples& e, const GpPrior& prior, const Eigen::MatrixXd& products)
      : e_(e), prior_(prior) {
    const Eigen::Index features = e.X.cols() - 1;
    K_ = prior.variance[0] * products;
    K_.array() += prior.variance[features];
  }

  [[nodiscard]] Eigen::Index size() const { return K_.rows(); }
  [[nodiscard]] Eigen::VectorXd latent(const Eigen::VectorXd& a) const { return K_ * a; }
  [[nodiscard]] double log_prior(const Eigen::VectorXd& a, const Eigen::VectorXd& f) const {
    return -0.5 * a.dot(f);
  }
  [[nodiscard]] Eigen::VectorXd newton_target(const Slopes& s,
                                              const Eigen::VectorXd& f,
                                              Eigen::LLT<Eigen::MatrixXd>& factor) const {
    Eigen::MatrixXd B = s.root_W.asDiagonal() * K_ * s.root_W.asDiagonal();
    B.diagonal().array() += 1.0;
    factor.compute(B);
    const Eigen::VectorXd b = s.root_W.cwiseAbs2().cwiseProduct(f) + s.gradient;
    return b - s.root_W.cwiseProduct(factor.solve(s.root_W.cwiseProduct(K_ * b)));
  }
  [[nodiscard]] double log_det_offset() const { return 0.0; }
  [[nodiscard]] Eigen::VectorXd theta(const Eigen::VectorXd& a) const {
    return prior_.variance.cwiseProduct(e_.X.transpose() * a);
  }

 private:
  const GpExamples& e_;
  const GpPrior& prior_;
  Eigen::MatrixXd K_;
};

// Newton's iterations for the log posterior, which is concave. Halving the step prevents overshoot
// where the logistic function is flat. `solution`: the start, or empty.
template <typename Posterior>
LaplaceMode find_mode(const Posterior& posterior,
                      const Eigen::VectorXd& y,
                      double tolerance,
                      Eigen::VectorXd& solution) {
  if (solution.size() == 0) solution = Eigen::VectorXd::Zero(posterior.size());
  LaplaceMode mode;
  Eigen::VectorXd f = posterior.latent(solution);
  double value = posterior.log_prior(solution, f) + log_likelihood(y, f);
  for (int iteration = 0; iteration < 100; ++iteration) {
    const Eigen::VectorXd target = posterior.newton_target(slopes_at(y, f), f, mode.factor);
    double gained = -1.0;
    for (double step = 1.0; gained < 0.0 && step > 1e-10; step *= 0.5) {
      const Eigen::VectorXd next = solution + step * (target - solution);
      const Eigen::VectorXd next_f = posterior.latent(next);
      const double found = posterior.log_prior(next, next_f) + log_likelihood(y, next_f);
      gained = found - value;
      if (gained < 0.0) continue;
      solution = next;
      f = next_f;
      value = found;
    }
    if (gained < tolerance * (1.0 + std::abs(value))) break;
  }
  const Slopes s = slopes_at(y, f);
  (void)posterior.newton_target(s, f, mode.factor);
  const double log_det = 2.0 * mode.factor.matrixLLT().diagonal().array().log().sum();
  mode.log_marginal = value - 0.5 * (log_det + posterior.log_det_offset());
  mode.theta = posterior.theta(solution);
  mode.root_W = s.root_W;
  mode.gradient = s.gradient;
  mode.f = std::move(f);
  return mode;
}

// Diagonal of R = (K + W^-1)^-1.
Eigen::VectorXd precision_of_sites(const GpExamples& e, const LaplaceMode& mode, bool by_features) {
  const Eigen::Index n = e.y.size();
  if (by_features) {
    const Eigen::MatrixXd Z =
        mode.factor.matrixL().solve((mode.root_W.asDiagonal() * e.X).transpose());
    return mode.root_W.cwiseAbs2().array() * (1.0 - Z.colwise().squaredNorm().transpose().array());
  }
  const Eigen::MatrixXd L_inverse = mode.factor.matrixL().solve(Eigen::MatrixXd::Identity(n, n));
  return mode.root_W.cwiseAbs2().cwiseProduct(L_inverse.colwise().squaredNorm().transpose());
}

}  // namespace

LaplaceMode laplace_mode(const GpExamples& e,
                         const GpPrior& prior,
                         bool by_features,
                         const Eigen::MatrixXd& products,
                         double tolerance,
                         Eigen::VectorXd& solution) {
  if (by_features) return find_mode(ByFeatures(e, prior), e.y, tolerance, solution);
  return find_mode(ByExamples(e, prior, products), e.y, tolerance, solution);
}

double best_sharpness(const GpExamples& e, const LaplaceMode& mode, bool by_features) {
  const Eigen::VectorXd R = precision_of_sites(e, mode, by_features);
  const auto log_score = [&](double sharpness) {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < R.size(); ++i) {
      const double W = mode.root_W[i] * mode.root_W[i];
      const double variance = std::max(1.0 / std::max(R[i], 1e-300) - 1.0 / W, 0.0);
      const double mean = mode.f[i] + mode.gradient[i] * (1.0 / W - 1.0 / std::max(R[i], 1e-300));
      // MacKay 1992: approximate logit of the averaged logistic function.
      sum += log_logistic(e.y[i] * sharpness * mean /
                          std::sqrt(1.0 + std::numbers::pi / 8.0 * variance));
    }
    return sum;
  };
  double best = 1.0;
  double best_score = log_score(1.0);
  for (int power = -8; power <= 24; ++power) {
    const double sharpness = std::exp2(0.125 * power);
    const double score = log_score(sharpness);
    if (score > best_score) {
      best = sharpness;
      best_score = score;
    }
  }
  return best;
}

}  // namespace roadbook
