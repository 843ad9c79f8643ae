#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

namespace roadbook {

/// Finds the items near a position in the plane.
class PlaceGrid {
 public:
  explicit PlaceGrid(double radius_m) : radius_m_(radius_m) {}
  void add(const Eigen::Vector3d& p, std::size_t which) {
    cells_[{cell(p.x()), cell(p.y())}].push_back(which);
  }
  /// Calls found(which) for all that may lie within the radius, in a fixed order.
  template <typename Found>
  void for_each_near(const Eigen::Vector3d& p, const Found& found) const {
    for (int i = cell(p.x()) - 1; i <= cell(p.x()) + 1; ++i)
      for (int j = cell(p.y()) - 1; j <= cell(p.y()) + 1; ++j)
        if (const auto at = cells_.find({i, j}); at != cells_.end())
          for (const std::size_t which : at->second) found(which);
  }

 private:
  [[nodiscard]] int cell(double x) const { return static_cast<int>(std::floor(x / radius_m_)); }
  double radius_m_;
  std::map<std::pair<int, int>, std::vector<std::size_t>> cells_;
};

}  // namespace roadbook
