#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

namespace roadbook {

// The occupancy grid as a smooth function of the plane, for a planner that follows gradients.

/// Square cells over a rectangle of the map's plane, row by row; row 0 has the least y.
struct OccupancyCells {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();  ///< outer corner of the first cell [m, map frame]
  double cell_m = 0.1;
  int columns = 0;
  int rows = 0;
  std::vector<float> probability;  ///< that a surface is in the cell; NaN: no reading reached it
  std::vector<float> sigma;        ///< standard deviation of the probability
  std::vector<float> age_s;        ///< since the newest reading of the cell; NaN: unknown
};

/// Occupancy at a point. The gradient is by x and y of the map frame [1/m].
struct OccupancyAt {
  double probability = 0.0;
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  double sigma = 0.0;
  double age_s = 0.0;  ///< NaN: unknown
};

/// Bicubic interpolation of the log odds of an occupancy grid (convolution kernel of Keys 1981 with
/// a = -1/2): equal to the grid at the middle of a cell, and its gradient is continuous. Log odds
/// are limited to +-16, the resolution of a probability in 32 bits. Immutable; safe to share
/// between threads.
class OccupancyField {
 public:
  /// Throws InvalidOption where the sizes contradict each other or a probability is not within 0 to
  /// 1.
  explicit OccupancyField(OccupancyCells cells);

  /// Empty where the cell that holds the point has no reading, and for a point that is not finite.
  /// Neighbours without a reading take the mean of the nearest cells that have one, so that they
  /// add no belief. Sigma and age are those of the cell that holds the point.
  [[nodiscard]] std::optional<OccupancyAt> at(const Eigen::Vector2d& p) const;

 private:
  [[nodiscard]] float log_odds(int column, int row) const;
  void extend();

  OccupancyCells cells_;
  std::vector<float> log_odds_;  ///< NaN: farther than two cells from any reading
};

}  // namespace roadbook
