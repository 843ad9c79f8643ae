#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "semantics/overhead/geotiff_writer.hpp"

namespace roadbook {

/// Square cells over the map's plane, a byte each, row 0 the northernmost: what a mask is made of.
class MaskGrid {
 public:
  /// Covers [low, high] [m], its lines at whole multiples of the resolution; all cells 0. Throws
  /// InvalidOption for a resolution at which the place has more than 2^27 cells, naming one that
  /// fits.
  MaskGrid(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double resolution_m);

  [[nodiscard]] const RasterPlace& place() const { return place_; }
  [[nodiscard]] const std::vector<std::uint8_t>& cells() const { return cells_; }
  [[nodiscard]] std::vector<std::uint8_t>& cells() { return cells_; }
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(place_.columns) +
           static_cast<std::size_t>(column);
  }
  [[nodiscard]] int column_of(double x) const;  ///< may lie outside
  [[nodiscard]] int row_of(double y) const;     ///< may lie outside
  [[nodiscard]] bool holds(int column, int row) const {
    return column >= 0 && row >= 0 && column < place_.columns && row < place_.rows;
  }
  [[nodiscard]] Eigen::Vector2d centre(int column, int row) const;

  /// Sets every cell that the area within a ring touches. The ring [m] is simple, convex or not,
  /// without repetition of its first point.
  void mark(const std::vector<Eigen::Vector2d>& ring, std::uint8_t value);

 private:
  void mark_row(const std::vector<Eigen::Vector2d>& ring, int row, std::uint8_t value);
  void fill(int row, double from_x, double to_x, std::uint8_t value);

  RasterPlace place_;
  std::vector<std::uint8_t> cells_;
};

}  // namespace roadbook
