#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "semantics/overhead/geotiff_writer.hpp"

namespace roadbook {

/// A mask: square cells in the map's plane, one byte each. Row 0 is the northernmost.
class MaskGrid {
 public:
  /// Covers [low, high] [m], with lines at whole multiples of the resolution; all cells 0. Throws
  /// InvalidOption, with a possible resolution, if there would be more than 2^27 cells.
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

  /// Sets every cell that the area inside a ring touches. The ring [m] does not cross itself, may
  /// be concave, and does not repeat its first point.
  void mark(const std::vector<Eigen::Vector2d>& ring, std::uint8_t value);

 private:
  void mark_row(const std::vector<Eigen::Vector2d>& ring, int row, std::uint8_t value);
  void fill(int row, double from_x, double to_x, std::uint8_t value);

  RasterPlace place_;
  std::vector<std::uint8_t> cells_;
};

}  // namespace roadbook
