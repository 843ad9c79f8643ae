#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace roadbook {

/// Number of a square cell of the plane (2) or of a cube (3) along each axis. Cell 0 of an axis
/// begins at the origin.
template <int kAxes>
using GridCell = std::array<std::int64_t, kAxes>;

/// The cell of side `cell_m` that contains `p` [m].
template <int kAxes>
[[nodiscard]] GridCell<kAxes> cell_at(const Eigen::Matrix<double, kAxes, 1>& p, double cell_m) {
  GridCell<kAxes> cell;
  for (int k = 0; k < kAxes; ++k)
    cell[static_cast<std::size_t>(k)] = static_cast<std::int64_t>(std::floor(p[k] / cell_m));
  return cell;
}

/// Values at points of the plane (or of space), stored by cells of one size: the values near a
/// point are found without a search through all of them.
template <typename Value, int kAxes = 2>
class CellGrid {
 public:
  using Point = Eigen::Matrix<double, kAxes, 1>;

  /// `cell_m`: side of a cell, above 0 [m].
  explicit CellGrid(double cell_m) : cell_m_(cell_m) {}

  void insert(const Point& p, const Value& value) {
    cells_[cell_at<kAxes>(p, cell_m_)].push_back(value);
  }

  /// Returns the values in the cell of `p`, in the order of insertion; null if the cell is empty.
  [[nodiscard]] const std::vector<Value>* find(const Point& p) const {
    return values_of(cell_at<kAxes>(p, cell_m_));
  }

  /// Calls visit(value) for all values up to a cell's side away from `p`, and for some that are
  /// farther away: those in the cell of `p` and in the cells around it. Order: ascending cells, the
  /// first axis first; in a cell the order of insertion.
  template <typename Visit>
  void visit_near(const Point& p, const Visit& visit) const {
    const GridCell<kAxes> centre = cell_at<kAxes>(p, cell_m_);
    std::array<int, kAxes> offset;
    offset.fill(-1);
    for (;;) {
      GridCell<kAxes> cell = centre;
      for (std::size_t k = 0; k < kAxes; ++k) cell[k] += offset[k];
      if (const auto* values = values_of(cell))
        for (const Value& value : *values) visit(value);
      std::size_t axis = kAxes;  // counts up in base three, the last axis fastest
      while (axis > 0 && ++offset[axis - 1] > 1) offset[--axis] = -1;
      if (axis == 0) return;
    }
  }

 private:
  struct Hash {
    std::size_t operator()(const GridCell<kAxes>& cell) const {
      std::uint64_t hash = 0;
      for (const std::int64_t c : cell)
        hash = hash * 0x9E3779B97F4A7C15U + static_cast<std::uint64_t>(c);
      return static_cast<std::size_t>(hash);
    }
  };
  [[nodiscard]] const std::vector<Value>* values_of(const GridCell<kAxes>& cell) const {
    const auto found = cells_.find(cell);
    return found == cells_.end() ? nullptr : &found->second;
  }

  double cell_m_;
  std::unordered_map<GridCell<kAxes>, std::vector<Value>, Hash> cells_;
};

}  // namespace roadbook
