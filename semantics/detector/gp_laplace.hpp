#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace roadbook {

// Laplace's approximation to the posterior of a Gaussian process classifier with a linear kernel
// (Rasmussen and Williams 2006, section 3.4): what GpClassifier is made of.

// GpExamples with a one behind their features, and labels.
struct GpExamples {
  Eigen::MatrixXd X;
  Eigen::VectorXd y;
};

struct GpPrior {
  Eigen::VectorXd variance;  ///< of each weight, the bias last
};

/// The mode of the posterior and what its curvature gives.
struct LaplaceMode {
  Eigen::VectorXd theta;   ///< weights and bias
  Eigen::VectorXd root_W;  ///< square root of the likelihood's curvature at each example
  Eigen::VectorXd f;
  Eigen::VectorXd gradient;  ///< of the log likelihood, by f
  Eigen::LLT<Eigen::MatrixXd> factor;
  double log_marginal = 0.0;
};

/// The mode for a prior. `by_features`: through the features' normal equations; else through the
/// examples' (algorithm 3.1), for which `products` are the products X X^T of the features alone.
/// `solution`: where to start (empty: at zero), then where it ended: weights and bias, or a with
/// f = K a.
[[nodiscard]] LaplaceMode laplace_mode(const GpExamples& e,
                                       const GpPrior& prior,
                                       bool by_features,
                                       const Eigen::MatrixXd& products,
                                       double tolerance,
                                       Eigen::VectorXd& solution);

/// The factor on the logit under which examples left out in turn are most likely: Laplace's
/// Gaussian sites have the leave-one-out predictions of regression (equation 5.12).
[[nodiscard]] double best_sharpness(const GpExamples& e, const LaplaceMode& mode, bool by_features);

/// A A^T, its lower half.
[[nodiscard]] Eigen::MatrixXd lower_gram(const Eigen::MatrixXd& A);

/// 1 / (1 + exp(-f)), without overflow.
[[nodiscard]] double logistic(double f);

}  // namespace roadbook
