#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sensors/range/inverse_range.hpp"

namespace roadbook {

// A part of the occupancy grid while readings change it.

/// Two numbers of one type, so that one instruction adds to both.
struct OccupancyCell {
  float change = 0.0F;  ///< of the log odds since before any reading
  float seen = 0.0F;    ///< readings that changed the cell; exact up to 2^24
};

/// Square cells over a rectangle of the plane; row 0 has the least y.
struct CellShape {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();  ///< outer corner of the first cell [m]
  double cell_m = 0.1;
  int columns = 0;
  int rows = 0;

  /// The smallest shape with lines at whole multiples of `cell_m` that holds the box [m].
  static CellShape over(const Eigen::Vector2d& least, const Eigen::Vector2d& most, double cell_m);
  [[nodiscard]] bool holds(int column, int row) const {
    return column >= 0 && row >= 0 && column < columns && row < rows;
  }
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
  [[nodiscard]] std::size_t size() const { return index(0, rows); }
  [[nodiscard]] Eigen::Vector2d middle(std::size_t cell) const {
    const std::size_t width = static_cast<std::size_t>(columns);
    return low + cell_m * Eigen::Vector2d(static_cast<double>(cell % width) + 0.5,
                                          static_cast<double>(cell / width) + 0.5);
  }
};

struct PatchGrid : CellShape {
  std::vector<OccupancyCell> cells;   ///< row by row
  std::vector<std::uint32_t> hits;    ///< readings that end in the cell
  std::vector<Eigen::Vector2f> ends;  ///< sum of their ends from the middle of the cell [cells]

  explicit PatchGrid(const CellShape& shape);
};

/// The cells on a beam, one for each column (row) if the beam runs rather along x (y): the cell
/// that holds the beam where it crosses the middle of the column. Fixed-point numbers have 16
/// fractional bits.
struct BeamSteps {
  int count = 0;
  std::int32_t first = 0;        ///< index of the cell of step 0 without its minor part
  std::int32_t major_step = 0;   ///< of the index
  std::int32_t minor_step = 0;   ///< of the index, for one cell across
  std::int32_t minor = 0;        ///< coordinate across, fixed-point
  std::int32_t minor_slope = 0;  ///< its change for each step
  std::int32_t entry = 0;        ///< position in the row of the inverse model, fixed-point, rounded
  std::int32_t entry_slope = 0;
  double chord_m = 0.0;  ///< length of the beam between two middles

  /// The steps of a beam up to `entries` of a row with `entry_m` between entries, cut where the
  /// beam leaves the grid. `along`: unit.
  BeamSteps(const CellShape& grid,
            const Eigen::Vector2d& origin,
            const Eigen::Vector2d& along,
            double entry_m,
            std::size_t entries);

  [[nodiscard]] std::size_t cell(int step) const {
    const std::int32_t across = (minor + step * minor_slope) >> 16;
    return static_cast<std::size_t>(first + step * major_step + across * minor_step);
  }
};

/// The row of a reading (`InverseRangeModel::changes`) up to the distance `limit_m`.
[[nodiscard]] std::span<const float> row_until(const InverseRangeModel& inverse,
                                               double read_m,
                                               double limit_m,
                                               double chord_m);

/// Adds one reading to the cells on its beam, up to the distance `limit_m` if the reading is
/// farther, and returns the number of cells changed.
std::size_t add_beam(PatchGrid& grid,
                     const Eigen::Vector2d& origin,
                     const Eigen::Vector2d& along,
                     double read_m,
                     double limit_m,
                     const InverseRangeModel& inverse);
inline std::size_t add_beam(PatchGrid& grid,
                            const Eigen::Vector2d& origin,
                            const Eigen::Vector2d& along,
                            double read_m,
                            const InverseRangeModel& inverse) {
  return add_beam(grid, origin, along, read_m, read_m, inverse);
}

/// The naive rule for one reading: `change` is -`certain`, 0 or `certain` (free, unknown,
/// occupied). Cells before the reading's end are free, the cell at the end is occupied.
std::size_t add_naive(PatchGrid& grid,
                      const Eigen::Vector2d& origin,
                      const Eigen::Vector2d& along,
                      double read_m,
                      double max_m,
                      float certain);

/// Calls visit(cell, entry) for every cell of a wide beam; `entry` as in `BeamSteps`.
template <typename Visit>
void for_each_cone_cell(const CellShape& grid,
                        const Eigen::Vector2d& origin,
                        const Eigen::Vector2d& along,
                        double cone_rad,
                        double entry_m,
                        std::size_t entries,
                        const Visit& visit) {
  const Eigen::Vector2d o = (origin - grid.low) / grid.cell_m;
  const double reach = static_cast<double>(entries) * entry_m / grid.cell_m;
  const double widest = std::cos(0.5 * cone_rad);
  const auto clamped = [](double x, int size) {
    return static_cast<int>(std::clamp(x, 0.0, static_cast<double>(size)));
  };
  const int to_row = clamped(o.y() + reach + 1.0, grid.rows);
  const int to_column = clamped(o.x() + reach + 1.0, grid.columns);
  for (int r = clamped(o.y() - reach, grid.rows); r < to_row; ++r)
    for (int c = clamped(o.x() - reach, grid.columns); c < to_column; ++c) {
      const Eigen::Vector2d d = Eigen::Vector2d(c + 0.5, r + 0.5) - o;
      const double distance = d.norm();
      if (d.dot(along) < widest * distance) continue;
      const auto entry = static_cast<std::size_t>(std::lround(distance * grid.cell_m / entry_m));
      if (entry < entries) visit(grid.index(c, r), entry);
    }
}

/// Counts the reading in `hits` of the cell where it ends; none for the maximum range.
void count_hit(PatchGrid& grid,
               const Eigen::Vector2d& origin,
               const Eigen::Vector2d& along,
               double read_m,
               double max_m);

}  // namespace roadbook
