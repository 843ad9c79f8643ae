#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/friction/friction_sample.hpp"

namespace roadbook {

// Noise model of friction readings: noise of each reading (scale, outliers, correlation with the
// previous reading) and a spatial bias, which varies from place to place.

struct FrictionNoise {
  double scale = 1.0;       ///< estimated over stated standard deviation, without outliers
  double outliers = 0.0;    ///< share of readings with ten times that noise
  double outliers_z = 0.0;  ///< square root of twice the gain in log likelihood
  double outliers_sigma = 0.0;
  double correlation = 0.0;  ///< between neighbouring readings
  double correlation_sigma = 0.0;
  double place_sd = 0.0;     ///< standard deviation of the spatial bias
  double place_sigma = 0.0;  ///< standard error of `place_sd`
  double place_z = 0.0;
  double place_length_m = 0.0;
  Eigen::MatrixXd place_terms;  ///< one row a cell, scaled by `place_sd`; empty: no spatial bias
  std::vector<double> outlier_part;  ///< probability that a reading is an outlier
  double log_likelihood = 0.0;       ///< without constants
  Eigen::VectorXd mean;              ///< coefficients of the mean columns
};

/// Columns of the mean, row-major, one row a reading.
using FrictionMean = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// For each reading its standard deviation, and whether its noise is correlated with the previous
/// reading (no gap between them).
struct ReadingNoise {
  std::vector<double> sigma;
  std::vector<bool> goes_on;
};
[[nodiscard]] ReadingNoise reading_noise(const std::vector<FrictionSample>& samples,
                                         const FrictionNoise& noise);

}  // namespace roadbook
