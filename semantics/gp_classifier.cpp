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
  Eigen::VectorXd theta;
  Eigen::VectorXd root_W;  ///< square root of the likelihood's curvature at each example
  Eigen::LLT<Eigen::MatrixXd> factor;
  double log_marginal = 0.0;
};

double log_posterior(const Examples& e, const Prior& prior, const Eigen::VectorXd& theta) {
  const Eigen::VectorXd f = e.X * theta;
  double sum = -0.5 * theta.cwiseAbs2().cwiseQuotient(prior.variance).sum();
  for (Eigen::Index i = 0; i < f.size(); ++i) sum += log_logistic(e.y[i] * f[i]);
  return sum;
}

struct Slopes {
  Eigen::VectorXd gradient;  ///< of the log likelihood, by f
  Eigen::VectorXd root_W;
};

Slopes slopes_at(const Examples& e, const Eigen::VectorXd& theta) {
  const Eigen::VectorXd f = e.X * theta;
  Slopes s{Eigen::VectorXd(f.size()), Eigen::VectorXd(f.size())};
  for (Eigen::Index i = 0; i < f.size(); ++i) {
    const double p = logistic(f[i]);
    s.gradient[i] = 0.5 * (e.y[i] + 1.0) - p;
    s.root_W[i] = std::sqrt(std::max(p * (1.0 - p), 1e-300));
  }
  return s;
}

Eigen::MatrixXd lower_gram(const Eigen::MatrixXd& A) {
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(A.rows(), A.rows());
  G.selfadjointView<Eigen::Lower>().rankUpdate(A);
  return G;
}

// Newton's step for theta, through the features' normal equations or, where there are fewer
// examples, through theirs (equation 3.43); `factor` is that of the matrix solved with.
Eigen::VectorXd newton_target(const Examples& e,
                              const Prior& prior,
                              const Slopes& s,
                              const Eigen::VectorXd& theta,
                              bool by_features,
                              Eigen::LLT<Eigen::MatrixXd>& factor) {
  const Eigen::MatrixXd weighted = s.root_W.asDiagonal() * e.X;
  const Eigen::VectorXd b =
      s.root_W.cwiseAbs2().cwiseProduct(e.X * theta) + s.gradient;  // W f + grad log p
  if (by_features) {
    Eigen::MatrixXd A = lower_gram(weighted.transpose());
    A.diagonal() += prior.variance.cwiseInverse();
    factor.compute(A);
    return factor.solve(e.X.transpose() * b);
  }
  Eigen::MatrixXd B = lower_gram(weighted * prior.variance.cwiseSqrt().asDiagonal());
  B.diagonal().array() += 1.0;
  factor.compute(B);
  const Eigen::VectorXd Kb = e.X * prior.variance.cwiseProduct(e.X.transpose() * b);
  const Eigen::VectorXd a = b - s.root_W.cwiseProduct(factor.solve(s.root_W.cwiseProduct(Kb)));
  return prior.variance.cwiseProduct(e.X.transpose() * a);
}

Mode find_mode(const Examples& e, const Prior& prior, Eigen::VectorXd theta, double tolerance) {
  const bool by_features = e.X.cols() <= e.X.rows();
  Mode mode;
  double value = log_posterior(e, prior, theta);
  for (int iteration = 0; iteration < 100; ++iteration) {
    const Slopes s = slopes_at(e, theta);
    const Eigen::VectorXd target = newton_target(e, prior, s, theta, by_features, mode.factor);
    // The posterior is concave; halving guards against overshoot where the logistic is flat.
    double step = 1.0;
    Eigen::VectorXd next = target;
    double found = log_posterior(e, prior, next);
    while (found < value && step > 1e-10) {
      step *= 0.5;
      next = theta + step * (target - theta);
      found = log_posterior(e, prior, next);
    }
    const double gained = found - value;
    if (gained >= 0.0) {
      theta = next;
      value = found;
    }
    if (gained < tolerance * (1.0 + std::abs(value))) break;
  }
  const Slopes s = slopes_at(e, theta);
  (void)newton_target(e, prior, s, theta, by_features, mode.factor);
  double log_det = 2.0 * mode.factor.matrixLLT().diagonal().array().log().sum();
  if (by_features) log_det += prior.variance.array().log().sum();
  mode.log_marginal = value - 0.5 * log_det;
  mode.theta = std::move(theta);
  mode.root_W = s.root_W;
  return mode;
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
  const auto mode_at = [&](double scale, const Eigen::VectorXd& start) {
    return find_mode(e, prior_of(features.cols(), scale, options.bias_scale), start,
                     options.tolerance);
  };
  double scale = options.scale;
  Mode mode = mode_at(scale, Eigen::VectorXd::Zero(e.X.cols()));
  // The marginal likelihood rises to one top: walk up in the better direction.
  for (const double factor : {2.0, 0.5}) {
    constexpr int kSteps = 8;
    for (int i = 0; options.learn_scale && i < kSteps; ++i) {
      Mode other = mode_at(factor * scale, mode.theta);
      if (!(other.log_marginal > mode.log_marginal)) break;
      mode = std::move(other);
      scale *= factor;
    }
    if (scale != options.scale) break;
  }
  GpClassifier trained;
  trained.weights_ = mode.theta.head(features.cols());
  trained.bias_ = mode.theta[features.cols()];
  trained.scale_ = scale;
  trained.bias_scale_ = options.bias_scale;
  trained.log_marginal_ = mode.log_marginal;
  trained.by_features_ = e.X.cols() <= e.X.rows();
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
