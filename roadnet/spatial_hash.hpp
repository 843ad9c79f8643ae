#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/cell_grid.hpp"

namespace roadbook {

/// A hash grid of points in cubes of one size. Finds the points near a position in constant time.
class SpatialHash {
 public:
  explicit SpatialHash(double cell_m) : cells_(cell_m) {}

  void insert(const Eigen::Vector3d& point) {
    cells_.insert(point, static_cast<int>(points_.size()));
    points_.push_back(point);
  }

  /// Calls visit(index, squared distance) for every point within `radius_m` <= cell size.
  template <typename Visit>
  void visit_near(const Eigen::Vector3d& place, double radius_m, Visit&& visit) const {
    cells_.visit_near(place, [&](int index) {
      const double d2 = (points_[static_cast<std::size_t>(index)] - place).squaredNorm();
      if (d2 <= radius_m * radius_m) visit(index, d2);
    });
  }

  /// Index of the nearest point within `radius_m` <= cell size; of equally near points the first
  /// inserted; -1 if there is none.
  [[nodiscard]] int nearest(const Eigen::Vector3d& place, double radius_m) const {
    int best = -1;
    double best_d2 = 0.0;
    visit_near(place, radius_m, [&](int index, double d2) {
      if (best < 0 || d2 < best_d2 || (d2 == best_d2 && index < best)) {
        best = index;
        best_d2 = d2;
      }
    });
    return best;
  }

 private:
  std::vector<Eigen::Vector3d> points_;
  CellGrid<int, 3> cells_;
};

}  // namespace roadbook
