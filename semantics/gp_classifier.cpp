#include "semantics/gp_classifier.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "base/error.hpp"

namespace roadbook {
namespace {

double logistic(double f) {
  return f >= 0.0 ? 1.0 / (1.0 + std::exp(-f)) : std::exp(f) / (1.0 + std::exp(f));
}
double log_logistic(double f) {
  return f >= 0.0 ? -std::log1p(std::exp(-f)) : f - std::log1p(std::exp(f));
}

// Examples with a one behind their features, and labels.
struct Examples {
  Eigen::MatrixXd X;
  Eigen::VectorXd y;
};

struct Prior {
  Eigen::VectorXd variance;  ///< of each weight, the bias last
};

// The mode of the posterior and what its curvature gives.
struct Mode {
  Eigen::VectorXd theta;   ///< weights and bias
  Eigen::VectorXd root_W;  ///< square root of the likelihood's curvature at each example
  Eigen::VectorXd f;
  Eigen::VectorXd gradient;  ///< of the log likelihood, by f
  Eigen::LLT<Eigen::MatrixXd> factor;
  double log_marginal = 0.0;
};

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

Eigen::MatrixXd lower_gram(const Eigen::MatrixXd& A) {
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(A.rows(), A.rows());
  G.selfadjointView<Eigen::Lower>().rankUpdate(A);
  return G;
}

double log_likelihood(const Eigen::VectorXd& y, const Eigen::VectorXd& f) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < f.size(); ++i) sum += log_logistic(y[i] * f[i]);
  return sum;
}

// The posterior over weights, through the features' normal equations.
class ByFeatures {
 public:
  ByFeatures(const Examples& e, const Prior& prior) : e_(e), prior_(prior) {}

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
  const Examples& e_;
  const Prior& prior_;
};

// The same through the examples' (Rasmussen and Williams, algorithm 3.1): f = K a. The products of
// the examples are made once for all scales.
class ByExamples {
 public:
  ByExamples(const Examples& e, const Prior& prior, const Eigen::MatrixXd& products)
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
  const Examples& e_;
  const Prior& prior_;
  Eigen::MatrixXd K_;
};

// Newton's iterations for the log posterior, which is concave; halving guards against overshoot
// where the logistic is flat. `solution`: where to start, or empty.
template <typename Posterior>
Mode find_mode(const Posterior& posterior,
               const Eigen::VectorXd& y,
               double tolerance,
               Eigen::VectorXd& solution) {
  if (solution.size() == 0) solution = Eigen::VectorXd::Zero(posterior.size());
  Mode mode;
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
Eigen::VectorXd precision_of_sites(const Examples& e, const Mode& mode, bool by_features) {
  const Eigen::Index n = e.y.size();
  if (by_features) {
    const Eigen::MatrixXd Z =
        mode.factor.matrixL().solve((mode.root_W.asDiagonal() * e.X).transpose());
    return mode.root_W.cwiseAbs2().array() * (1.0 - Z.colwise().squaredNorm().transpose().array());
  }
  const Eigen::MatrixXd L_inverse = mode.factor.matrixL().solve(Eigen::MatrixXd::Identity(n, n));
  return mode.root_W.cwiseAbs2().cwiseProduct(L_inverse.colwise().squaredNorm().transpose());
}

// The factor on the logit under which examples left out in turn are most likely: Laplace's Gaussian
// sites have the leave-one-out predictions of regression (Rasmussen and Williams, equation 5.12).
double best_sharpness(const Examples& e, const Mode& mode, bool by_features) {
  const Eigen::VectorXd R = precision_of_sites(e, mode, by_features);
  const auto log_score = [&](double sharpness) {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < R.size(); ++i) {
      const double W = mode.root_W[i] * mode.root_W[i];
      const double variance = std::max(1.0 / std::max(R[i], 1e-300) - 1.0 / W, 0.0);
      const double mean = mode.f[i] + mode.gradient[i] * (1.0 / W - 1.0 / std::max(R[i], 1e-300));
      // MacKay 1992: the logit of an averaged logistic, nearly.
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

Prior prior_of(Eigen::Index features, double scale, double bias_scale) {
  Prior prior{Eigen::VectorXd::Constant(features + 1, scale * scale)};
  prior.variance[features] = bias_scale * bias_scale;
  return prior;
}

Examples examples_of(const Eigen::MatrixXd& features, const std::vector<int>& labels) {
  const auto count = static_cast<Eigen::Index>(labels.size());
  if (features.rows() != count)
    throw InvalidOption("labels", std::to_string(count), std::to_string(features.rows()));
  if (!features.allFinite())
    throw InvalidOption("features", "a value that is not finite", "numbers");
  Examples e{Eigen::MatrixXd(count, features.cols() + 1), Eigen::VectorXd(count)};
  e.X << features, Eigen::VectorXd::Ones(count);
  bool positive = false;
  bool negative = false;
  for (Eigen::Index i = 0; i < count; ++i) {
    const int label = labels[static_cast<std::size_t>(i)];
    if (label != 1 && label != -1) throw InvalidOption("labels", std::to_string(label), "1 or -1");
    e.y[i] = label;
    (label > 0 ? positive : negative) = true;
  }
  if (!positive || !negative)
    throw InvalidOption("labels", "one class", "examples of both classes");
  return e;
}

}  // namespace

void GpClassifierOptions::check() const {
  const auto positive = [](const char* name, double value) {
    if (!(value > 0.0)) throw InvalidOption(name, std::to_string(value), "> 0");
  };
  positive("scale", scale);
  positive("bias_scale", bias_scale);
  positive("tolerance", tolerance);
}

GpClassifier GpClassifier::train(const Eigen::MatrixXd& features,
                                 const std::vector<int>& labels,
                                 const GpClassifierOptions& options) {
  options.check();
  const Examples e = examples_of(features, labels);
  // A step costs the cube of the smaller side; the features' also their product with the examples.
  const bool by_features = 2 * e.X.cols() <= e.X.rows();
  Eigen::MatrixXd products;
  if (!by_features) {
    products = lower_gram(features);
    products.triangularView<Eigen::StrictlyUpper>() = products.transpose();
  }
  const auto mode_at = [&](double scale, Eigen::VectorXd& solution) {
    const Prior prior = prior_of(features.cols(), scale, options.bias_scale);
    if (by_features) return find_mode(ByFeatures(e, prior), e.y, options.tolerance, solution);
    return find_mode(ByExamples(e, prior, products), e.y, options.tolerance, solution);
  };
  double scale = options.scale;
  Eigen::VectorXd solution;
  Mode mode = mode_at(scale, solution);
  // The marginal likelihood rises to one top: walk up in the better direction.
  for (const double factor : {2.0, 0.5}) {
    constexpr int kSteps = 8;
    for (int i = 0; options.learn_scale && i < kSteps; ++i) {
      // Examples' weights stand for the same f at another scale when they are divided by its
      // square.
      Eigen::VectorXd start =
          by_features ? solution : Eigen::VectorXd(solution / (factor * factor));
      Mode other = mode_at(factor * scale, start);
      if (!(other.log_marginal > mode.log_marginal)) break;
      mode = std::move(other);
      solution = std::move(start);
      scale *= factor;
    }
    if (scale != options.scale) break;
  }
  GpClassifier trained;
  trained.weights_ = mode.theta.head(features.cols());
  trained.bias_ = mode.theta[features.cols()];
  trained.scale_ = scale;
  if (options.calibrate) trained.sharpness_ = best_sharpness(e, mode, by_features);
  trained.bias_scale_ = options.bias_scale;
  trained.log_marginal_ = mode.log_marginal;
  trained.by_features_ = by_features;
  if (!trained.by_features_) trained.weighted_ = mode.root_W.asDiagonal() * e.X;
  trained.factor_ = std::move(mode.factor);
  return trained;
}

GpPrediction GpClassifier::predict(const Eigen::VectorXd& x) const {
  ROADBOOK_ASSERT(x.size() == weights_.size());
  Eigen::VectorXd phi(x.size() + 1);
  phi << x, 1.0;
  GpPrediction prediction;
  prediction.mean = weights_.dot(x) + bias_;
  if (by_features_) {
    prediction.variance = factor_.matrixL().solve(phi).squaredNorm();
  } else {
    const Eigen::VectorXd variance = prior_of(x.size(), scale_, bias_scale_).variance;
    const Eigen::VectorXd scaled = variance.cwiseProduct(phi);
    prediction.variance =
        phi.dot(scaled) - factor_.matrixL().solve(weighted_ * scaled).squaredNorm();
    prediction.variance = std::max(prediction.variance, 0.0);
  }
  prediction.probability = logistic_gaussian(prediction.mean, prediction.variance);
  if (sharpness_ != 1.0) {
    const double p = std::clamp(prediction.probability, 1e-12, 1.0 - 1e-12);
    prediction.probability = logistic(sharpness_ * std::log(p / (1.0 - p)));
  }
  return prediction;
}

double logistic_gaussian(double mean, double variance) {
  // Trapezoids over +-9 sigma: for smooth functions that vanish at both ends the error falls faster
  // than any power. A wide Gaussian needs steps that still resolve the logistic's slope.
  const double sigma = std::sqrt(std::max(variance, 0.0));
  if (sigma < 1e-9) return logistic(mean);
  constexpr double kReach = 9.0;
  const int steps = std::clamp(static_cast<int>(kReach * sigma * 8.0), 160, 20000);
  const double h = 2.0 * kReach / steps;
  double sum = 0.0;
  for (int i = 0; i <= steps; ++i) {
    const double z = -kReach + h * i;
    sum += std::exp(-0.5 * z * z) * logistic(mean + sigma * z);
  }
  return sum * h / std::sqrt(2.0 * std::numbers::pi);
}

}  // namespace roadbook
