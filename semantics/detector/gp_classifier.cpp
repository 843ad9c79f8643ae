#include "semantics/detector/gp_classifier.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "base/digest.hpp"
#include "base/error.hpp"
#include "semantics/detector/gp_laplace.hpp"

namespace roadbook {
namespace {

GpPrior prior_of(Eigen::Index features, double scale, double bias_scale) {
  GpPrior prior{Eigen::VectorXd::Constant(features + 1, scale * scale)};
  prior.variance[features] = bias_scale * bias_scale;
  return prior;
}

GpExamples examples_of(const Eigen::MatrixXd& features, const std::vector<int>& labels) {
  const auto count = static_cast<Eigen::Index>(labels.size());
  if (features.rows() != count)
    throw InvalidOption("labels", std::to_string(count), std::to_string(features.rows()));
  if (!features.allFinite())
    throw InvalidOption("features", "a value that is not finite", "numbers");
  GpExamples e{Eigen::MatrixXd(count, features.cols() + 1), Eigen::VectorXd(count)};
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
  const GpExamples e = examples_of(features, labels);
  // One step costs the cube of the smaller side. Steps over features also cost the product of
  // features and examples.
  const bool by_features = 2 * e.X.cols() <= e.X.rows();
  Eigen::MatrixXd products;
  if (!by_features) {
    products = lower_gram(features);
    products.triangularView<Eigen::StrictlyUpper>() = products.transpose();
  }
  const auto mode_at = [&](double scale, Eigen::VectorXd& solution) {
    const GpPrior prior = prior_of(features.cols(), scale, options.bias_scale);
    return laplace_mode(e, prior, by_features, products, options.tolerance, solution);
  };
  double scale = options.scale;
  Eigen::VectorXd solution;
  LaplaceMode mode = mode_at(scale, solution);
  // The marginal likelihood has one maximum over the scale: go in the better direction while it
  // rises.
  for (const double factor : {2.0, 0.5}) {
    constexpr int kSteps = 8;
    for (int i = 0; options.learn_scale && i < kSteps; ++i) {
      // The same f at another scale has these example weights, divided by the square of the scale
      // factor.
      Eigen::VectorXd start =
          by_features ? solution : Eigen::VectorXd(solution / (factor * factor));
      LaplaceMode other = mode_at(factor * scale, start);
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

std::string GpClassifier::digest() const {
  Sha256 digest;
  for (const double weight : weights_) digest.update(weight);
  for (const double number : {bias_, scale_, sharpness_}) digest.update(number);
  return digest.hex().substr(0, 16);
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
  if (sharpness_ != 1.0 || shift_ != 0.0) {
    // The probability never is 1: only a person's label has probability 1, and its logit is
    // infinite.
    const double farthest = logit_of(1.0);
    prediction.probability = logistic(
        std::clamp(sharpness_ * logit_of(prediction.probability) + shift_, -farthest, farthest));
  }
  return prediction;
}

Eigen::MatrixXd GpClassifier::covariance(const Eigen::MatrixXd& features) const {
  ROADBOOK_ASSERT(features.cols() == weights_.size());
  Eigen::MatrixXd phi(features.cols() + 1, features.rows());
  phi << features.transpose(), Eigen::RowVectorXd::Ones(features.rows());
  if (by_features_) {
    const Eigen::MatrixXd root = factor_.matrixL().solve(phi);
    return root.transpose() * root;
  }
  const Eigen::MatrixXd scaled =
      prior_of(features.cols(), scale_, bias_scale_).variance.asDiagonal() * phi;
  const Eigen::MatrixXd known = factor_.matrixL().solve(weighted_ * scaled);
  return phi.transpose() * scaled - known.transpose() * known;
}

double logit_of(double probability) {
  const double p = std::clamp(probability, 1e-12, 1.0 - 1e-12);
  return std::log(p / (1.0 - p));
}

double logistic_gaussian(double mean, double variance) {
  // Trapezoidal rule over +-9 sigma. For smooth functions that vanish at both ends, its error falls
  // faster than any power of the step. For a wide Gaussian, the steps must still resolve the slope
  // of the logistic function.
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
