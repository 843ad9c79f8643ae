#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <string>
#include <vector>

namespace roadbook {

// Gaussian process classifier with a linear kernel (document 004, V-A.2): for labels y = +-1,
//   p(y | f) = 1 / (1 + exp(-y f)),   f(x) = w.x + b,   w ~ N(0, s^2 I),   b ~ N(0, s_b^2),
// which is the kernel k(x, x') = s^2 x.x' + s_b^2. The posterior is Laplace's approximation
// (Rasmussen and Williams 2006, section 3.4), found in whichever space is smaller: that of the
// features or that of the examples. Both give the same numbers.

struct GpClassifierOptions {
  double scale = 1.0;       ///< s: standard deviation of a weight
  double bias_scale = 3.0;  ///< s_b: how unequal the classes may be
  bool learn_scale =
      true;  ///< s by the largest marginal likelihood, among powers of two about `scale`
  /// Laplace's approximation is too careful in many dimensions: its variance pulls probabilities to
  /// a half (Kuss and Rasmussen 2005). The logit of the probability is then taken times the factor
  /// that makes the examples, each left out in turn, most likely. One half stays where it is.
  bool calibrate = false;
  double tolerance = 1e-10;  ///< of Newton's iterations, in the log posterior

  /// Throws InvalidOption.
  void check() const;
};

struct GpPrediction {
  double mean = 0.0;         ///< of f
  double variance = 0.0;     ///< of f
  double probability = 0.5;  ///< of y = +1, f integrated out
};

class GpClassifier {
 public:
  /// One example a row of `features` (n x D), `labels[i]` +1 or -1. Both classes must be there and
  /// every feature finite: InvalidOption otherwise.
  static GpClassifier train(const Eigen::MatrixXd& features,
                            const std::vector<int>& labels,
                            const GpClassifierOptions& options = {});

  [[nodiscard]] Eigen::Index feature_size() const { return weights_.size(); }
  /// Mean of f is `weights().dot(x) + bias()`: for searches over many windows.
  [[nodiscard]] const Eigen::VectorXd& weights() const { return weights_; }
  [[nodiscard]] double bias() const { return bias_; }
  [[nodiscard]] double scale() const { return scale_; }
  /// Factor on the logit of the probability; 1 unless calibrated.
  [[nodiscard]] double sharpness() const { return sharpness_; }
  /// What is added to that logit: 0 unless the things asked about have another prior than the
  /// examples (semantics/detector/search_prior.hpp).
  [[nodiscard]] double shift() const { return shift_; }
  void set_shift(double shift) { shift_ = shift; }
  /// Names what was learnt: 16 hex digits over the bits of weights, bias, scale and sharpness (not
  /// of the shift, which is no part of it). The same examples in the same order, the same name.
  [[nodiscard]] std::string digest() const;
  [[nodiscard]] double log_marginal_likelihood() const { return log_marginal_; }

  [[nodiscard]] GpPrediction predict(const Eigen::VectorXd& x) const;
  /// Covariance of f at several places (one a row of `features`, n x D) with one another: n x n.
  /// Its diagonal holds the variances that `predict` gives.
  [[nodiscard]] Eigen::MatrixXd covariance(const Eigen::MatrixXd& features) const;

 private:
  Eigen::VectorXd weights_;
  double bias_ = 0.0;
  double scale_ = 1.0;
  double sharpness_ = 1.0;
  double shift_ = 0.0;
  double bias_scale_ = 1.0;
  double log_marginal_ = 0.0;
  // Either the Cholesky factor of A = X^T W X + Lambda (features), or that of
  // B = I + W^1/2 K W^1/2 with W^1/2 X (examples).
  bool by_features_ = true;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::MatrixXd weighted_;
};

/// log(p / (1 - p)), finite: of p no nearer to 0 and 1 than 1e-12.
[[nodiscard]] double logit_of(double probability);

/// Integral of the logistic function over N(mean, variance), to 1e-8.
[[nodiscard]] double logistic_gaussian(double mean, double variance);

}  // namespace roadbook
