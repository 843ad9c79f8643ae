#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "speedmap/property_map/knots.hpp"

namespace roadbook {

// Gaussian-process regression over path coordinates: the baseline for the property map. The kernel
// is squared-exponential with different lengths along and across, plus noise. Cost O(n^3), for some
// hundreds of values.

struct GaussianProcessOptions {
  int starts = 2;       ///< of the search for hyper-parameters: short and long
  int iterations = 60;  ///< of each
};

/// Hyper-parameters, as standard deviations and lengths.
struct GaussianProcessKernel {
  double length_s_m = 10.0;
  double length_e_m = 2.0;
  double sigma = 0.2;
  double noise = 0.05;
};

class GaussianProcess {
 public:
  /// Maximises the marginal likelihood (BFGS on logarithms, analytic gradient). At least 3 values.
  static GaussianProcess fit(const std::vector<PathPlace>& places,
                             const std::vector<double>& values,
                             const GaussianProcessOptions& options = {});
  GaussianProcess(const std::vector<PathPlace>& places,
                  const std::vector<double>& values,
                  const GaussianProcessKernel& kernel);

  struct Prediction {
    double mean = 0.0;
    double variance = 0.0;  ///< of a measurement: noise included
  };
  [[nodiscard]] Prediction predict(const PathPlace& v) const;
  [[nodiscard]] double log_likelihood() const { return log_likelihood_; }
  /// d log likelihood / d logarithm of (length_s, length_e, sigma, noise).
  [[nodiscard]] Eigen::Vector4d gradient() const;
  [[nodiscard]] const GaussianProcessKernel& kernel() const { return kernel_; }

 private:
  std::vector<PathPlace> places_;
  GaussianProcessKernel kernel_;
  double mean_ = 0.0;
  Eigen::MatrixXd covariance_;  ///< without the noise
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::VectorXd weights_;  ///< (K + noise)^-1 (y - mean)
  double log_likelihood_ = 0.0;
};

/// Kalman filter of a property that does not depend on the position, with a random walk of `walk`
/// (standard deviation) per measurement. The estimate after all values is also the prediction for
/// any position ahead.
struct KalmanEstimate {
  double mean = 0.0;
  double variance = 0.0;  ///< of the state
};
[[nodiscard]] KalmanEstimate kalman_constant(const std::vector<double>& values,
                                             double measurement_sigma,
                                             double walk);

}  // namespace roadbook
