#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace roadbook {

// Laplace's approximation to the posterior of a Gaussian process classifier with a linear kernel
// (Rasmussen and Williams 2006, section 3.4). Used by GpClassifier.

// Training examples: features with an appended column of ones, and labels +1 or -1.
struct GpExamples {
  Eigen::MatrixXd X;
  Eigen::VectorXd y;
};

struct GpPrior {
  Eigen::VectorXd variance;  ///< of each weight; the bias is the last
};

/// Mode of the posterior, with the quantities needed for predictions.
struct LaplaceMode {
  Eigen::VectorXd theta;   ///< weights and bias
  Eigen::VectorXd root_W;  ///< square root of the likelihood's curvature at each example
  Eigen::VectorXd f;
  Eigen::VectorXd gradient;  ///< of the log likelihood, by f
  Eigen::LLT<Eigen::MatrixXd> factor;
  double log_marginal = 0.0;
};

/// Finds the mode by Newton's method. `by_features` selects normal equations over features,
/// otherwise over examples (algorithm 3.1); the latter need `products` = X X^T without the column
/// of ones. `solution`: start value (empty: zero), replaced by the result: weights and bias, or a
/// with f = K a.
[[nodiscard]] LaplaceMode laplace_mode(const GpExamples& e,
                                       const GpPrior& prior,
                                       bool by_features,
                                       const Eigen::MatrixXd& products,
                                       double tolerance,
                                       Eigen::VectorXd& solution);

/// Calibration factor on the logit that maximises the leave-one-out likelihood of the examples.
/// Leave-one-out means and variances follow from the Gaussian sites of Laplace's approximation as
/// in regression (equation 5.12).
[[nodiscard]] double best_sharpness(const GpExamples& e, const LaplaceMode& mode, bool by_features);

/// Lower triangle of A A^T.
[[nodiscard]] Eigen::MatrixXd lower_gram(const Eigen::MatrixXd& A);

/// 1 / (1 + exp(-f)), without overflow.
[[nodiscard]] double logistic(double f);

}  // namespace roadbook
