#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/friction/friction_readings.hpp"
#include "diagnosis/numerics/place_basis.hpp"

namespace roadbook {

// How the readings scatter about their mean: noise of each reading (its size, outliers, correlation
// with the one before) and a bias that changes from place to place.

struct FrictionNoise {
  double scale = 1.0;       ///< standard deviation over the stated one, without outliers
  double outliers = 0.0;    ///< share with ten times that
  double outliers_z = 0.0;  ///< root of twice the log likelihood gained
  double outliers_sigma = 0.0;
  double correlation = 0.0;  ///< of neighbouring readings
  double correlation_sigma = 0.0;
  double place_sd = 0.0;     ///< of the bias of places
  double place_sigma = 0.0;  ///< of `place_sd`
  double place_z = 0.0;
  double place_length_m = 0.0;
  Eigen::MatrixXd place_terms;       ///< cells x terms, scaled by `place_sd`; none: no such bias
  std::vector<double> outlier_part;  ///< of each reading: probability that it is an outlier
  double log_likelihood = 0.0;       ///< of the readings; but for constants
  Eigen::VectorXd mean;              ///< weights of the mean's columns
};

/// Columns of the mean, row-major: one row a reading.
using FrictionMean = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Estimated with the columns of `mean` free; those after the first `flat` are held by a standard
/// normal prior. A part of the noise is taken in only where the likelihood wants it clearly; the
/// bias of places only if `places`.
[[nodiscard]] FrictionNoise friction_noise(const std::vector<FrictionSample>& samples,
                                           const PlaceCells& cells,
                                           const FrictionMean& mean,
                                           Eigen::Index flat,
                                           bool places = true);

/// Of each reading: its own standard deviation, and whether the noise goes on from the reading
/// before (no gap between them).
struct ReadingNoise {
  std::vector<double> sigma;
  std::vector<bool> goes_on;
};
[[nodiscard]] ReadingNoise reading_noise(const std::vector<FrictionSample>& samples,
                                         const FrictionNoise& noise);

}  // namespace roadbook
