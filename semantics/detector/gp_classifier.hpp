#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <string>
#include <vector>

namespace roadbook {

// Gaussian process classifier with a linear kernel (used by [metric-semantic maps, section V-A.2]).
// For labels y = +-1,
//   p(y | f) = 1 / (1 + exp(-y f)),   f(x) = w.x + b,   w ~ N(0, s^2 I),   b ~ N(0, s_b^2),
// that is the kernel k(x, x') = s^2 x.x' + s_b^2. The posterior is Laplace's approximation
// (Rasmussen and Williams 2006, section 3.4). It is computed with matrices of the number of
// features or of the number of examples, whichever costs less; both give the same result.

struct GpClassifierOptions {
  double scale = 1.0;       ///< s: standard deviation of a weight
  double bias_scale = 3.0;  ///< s_b: standard deviation of the bias
  bool learn_scale =
      true;  ///< s by the largest marginal likelihood, among powers of two about `scale`
  /// In many dimensions the variance of Laplace's approximation pulls probabilities towards a half
  /// (Kuss and Rasmussen 2005). With `calibrate`, the logit of the probability is multiplied by the
  /// factor that maximises the leave-one-out likelihood of the examples. A probability of one half
  /// does not change.
  bool calibrate = false;
  double tolerance = 1e-10;  ///< of Newton's method, relative change of the log posterior

  /// Throws InvalidOption.
  void check() const;
};

struct GpPrediction {
  double mean = 0.0;         ///< of f
  double variance = 0.0;     ///< of f
  double probability = 0.5;  ///< of y = +1, averaged over f
};

class GpClassifier {
 public:
  /// `features`: n x D, one example per row; `labels[i]`: +1 or -1. Throws InvalidOption unless
  /// both classes are present and all features are finite.
  static GpClassifier train(const Eigen::MatrixXd& features,
                            const std::vector<int>& labels,
                            const GpClassifierOptions& options = {});

  [[nodiscard]] Eigen::Index feature_size() const { return weights_.size(); }
  /// Posterior mean of f is `weights().dot(x) + bias()`; a search evaluates this for many windows.
  [[nodiscard]] const Eigen::VectorXd& weights() const { return weights_; }
  [[nodiscard]] double bias() const { return bias_; }
  [[nodiscard]] double scale() const { return scale_; }
  /// Calibration factor on the logit of the probability; 1 if not calibrated.
  [[nodiscard]] double sharpness() const { return sharpness_; }
  /// Term added to the calibrated logit: 0 unless the prior of a search differs from that of the
  /// examples (semantics/detector/search_prior.hpp).
  [[nodiscard]] double shift() const { return shift_; }
  void set_shift(double shift) { shift_ = shift; }
  /// Identifies the trained classifier: 16 hex digits of a SHA-256 over weights, bias, scale and
  /// calibration factor, without the shift. Equal examples in equal order give an equal digest.
  [[nodiscard]] std::string digest() const;
  [[nodiscard]] double log_marginal_likelihood() const { return log_marginal_; }

  [[nodiscard]] GpPrediction predict(const Eigen::VectorXd& x) const;
  /// Posterior covariance of f between several inputs (n x D, one per row): n x n. Its diagonal
  /// holds the variances that `predict` returns.
  [[nodiscard]] Eigen::MatrixXd covariance(const Eigen::MatrixXd& features) const;

 private:
  Eigen::VectorXd weights_;
  double bias_ = 0.0;
  double scale_ = 1.0;
  double sharpness_ = 1.0;
  double shift_ = 0.0;
  double bias_scale_ = 1.0;
  double log_marginal_ = 0.0;
  // by_features_: factor_ is the Cholesky factor of A = X^T W X + Lambda. Otherwise it is that of B
  // = I + W^1/2 K W^1/2, and weighted_ is W^1/2 X.
  bool by_features_ = true;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::MatrixXd weighted_;
};

/// log(p / (1 - p)) with p limited to [1e-12, 1 - 1e-12].
[[nodiscard]] double logit_of(double probability);

/// Integral of the logistic function over N(mean, variance); absolute error below 1e-8.
[[nodiscard]] double logistic_gaussian(double mean, double variance);

}  // namespace roadbook
