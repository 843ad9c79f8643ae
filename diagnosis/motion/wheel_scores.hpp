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

/// What of a row's variance comes of its readings and what of the way.
struct RowVariance {
  double read = 0.0;
  double walk = 0.0;
  [[nodiscard]] double total() const { return read + walk; }
  [[nodiscard]] double part_of_readings() const { return read / total(); }
};
[[nodiscard]] RowVariance row_variance(const WheelWindow& w,
                                       std::size_t row,
                                       const WheelParameters& p);

/// Derivatives of the windows' log likelihood by the parameters: their sum, what it is expected to
/// fall by, and the sum of their products.
struct WheelScores {
  using Information = Eigen::Matrix<double, kWheelParameters, kWheelParameters>;
  WheelParameters sum = WheelParameters::Zero();
  Information information = Information::Zero();
  Information scatter = Information::Zero();
};

/// Where there are outliers, windows are mixtures by which of their readings are. Where there are
/// none, Student's scores, which a few that nobody knows of move little.
[[nodiscard]] WheelScores wheel_scores(const std::vector<WheelWindow>& windows,
                                       const WheelParameters& p);

/// Fisher scoring of the free parameters; what the windows do not tell stays near its start.
[[nodiscard]] WheelParameters fitted_wheels(const std::vector<WheelWindow>& windows,
                                            WheelParameters p,
                                            const FreeParameters& free);

}  // namespace roadbook
