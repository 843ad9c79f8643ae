#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/motion/wheel_windows.hpp"

namespace roadbook {

// The noise that windows of the wheels' readings show, and scores of it.

/// Logarithms of the variances of distance and heading after a metre and of a reading, the changes
/// of all with speed and turn, and of the odds that a reading is an outlier, whose noise is ten
/// times as large.
enum WheelParameter : Eigen::Index {
  kAlongWalk,
  kHeadingWalk,
  kReadingNoise,
  kBySpeed,
  kByTurn,
  kOutlierOdds,
  kWheelParameters
};
using WheelParameters = Eigen::Vector<double, kWheelParameters>;
using FreeParameters = std::vector<Eigen::Index>;

/// Odds below which there are no outliers.
inline constexpr double kNoOutliers = -15.0;

/// Parts of a row's variance: noise of its readings, and scatter along the way.
struct RowVariance {
  double read = 0.0;
  double walk = 0.0;
  [[nodiscard]] double total() const { return read + walk; }
  [[nodiscard]] double part_of_readings() const { return read / total(); }
};
[[nodiscard]] RowVariance row_variance(const WheelWindow& w,
                                       std::size_t row,
                                       const WheelParameters& p);

/// Derivatives of the windows' log likelihood by the parameters: their sum, its expected decrease,
/// and the sum of their products.
struct WheelScores {
  using Information = Eigen::Matrix<double, kWheelParameters, kWheelParameters>;
  WheelParameters sum = WheelParameters::Zero();
  Information information = Information::Zero();
  Information scatter = Information::Zero();
};

/// With outliers, windows are mixtures over the possible patterns of outliers. Without outliers,
/// scores are Student's, so that a few unknown outliers have little influence.
[[nodiscard]] WheelScores wheel_scores(const std::vector<WheelWindow>& windows,
                                       const WheelParameters& p);

/// Fisher scoring of the free parameters. Parameters that the windows do not determine stay near
/// their start.
[[nodiscard]] WheelParameters fitted_wheels(const std::vector<WheelWindow>& windows,
                                            WheelParameters p,
                                            const FreeParameters& free);

}  // namespace roadbook
