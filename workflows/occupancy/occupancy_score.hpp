#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "exchange/layers/occupancy_layers.hpp"
#include "mapping/map.hpp"

namespace roadbook {

// The grid against the seven demands of document 001 on a representation of the environment.

/// Figures that need no truth.
struct OccupancyFigures {
  std::size_t cells = 0;  ///< that a reading reached
  std::size_t free = 0;
  std::size_t occupied = 0;
  std::size_t undecided = 0;    ///< reached, neither free nor occupied
  double bytes_per_m2 = 0.0;    ///< of the packed patches, over the ground that readings reached
  double merged_share = 0.0;    ///< regions of a quadtree over cells: what a planner must look at
  double vanished_share = 0.0;  ///< of free cells: with at least two echoes in them; moving things
};
[[nodiscard]] OccupancyFigures occupancy_figures(const StoredOccupancy& stored,
                                                 const OccupancyGrid& grid);

/// True cells under a grid: occupied where a surface crosses the cell.
struct TrueCells {
  std::vector<std::uint8_t> occupied;  ///< by cell of the grid's shape
};
/// Line segments [m, map] drawn into cells.
[[nodiscard]] TrueCells true_cells(
    const CellShape& shape,
    const std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>& surfaces);

/// Figures against the truth, over the cells that a reading reached.
struct OccupancyTruth {
  /// Expected calibration error: mean of |share of occupied cells - mean probability| over ten
  /// equal intervals of the probability, weighted by their cells.
  double calibration_error = 0.0;
  double free_recall = 0.0;      ///< share of free cells that are called free
  double occupied_recall = 0.0;  ///< share of occupied cells with an occupied one within a cell
  double occupied_called_free = 0.0;  ///< share of occupied cells without an undecided or occupied
                                      ///< cell within one cell
  std::vector<double> mean_probability;  ///< of each interval
  std::vector<double> true_share;        ///< of occupied cells in each interval
  std::vector<std::size_t> count;        ///< cells in each interval
};
[[nodiscard]] OccupancyTruth score_occupancy(const OccupancyGrid& grid,
                                             double prior_log_odds,
                                             const TrueCells& truth);

/// Free cells that people crossed (0.3 m around each place) and that a reading reached.
struct OccupancyTrails {
  std::size_t crossed = 0;
  double called_occupied = 0.0;  ///< share of them
};
[[nodiscard]] OccupancyTrails score_trails(const OccupancyGrid& grid,
                                           double prior_log_odds,
                                           const TrueCells& truth,
                                           const std::vector<Eigen::Vector2d>& walked);

}  // namespace roadbook
