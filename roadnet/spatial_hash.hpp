#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace roadbook {

/// Points in cubes of one size: what lies near a place is found in constant time.
class SpatialHash {
 public:
  explicit SpatialHash(double cell_m) : cell_m_(cell_m) {}

  void insert(const Eigen::Vector3d& point) {
    cells_[key(point, 0, 0, 0)].push_back(static_cast<int>(points_.size()));
    points_.push_back(point);
  }

  /// Calls visit(index, squared distance) for every point within `radius_m` <= cell size.
  template <typename Visit>
  void visit_near(const Eigen::Vector3d& place, double radius_m, Visit&& visit) const {
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        for (int z = -1; z <= 1; ++z) {
          const auto cell = cells_.find(key(place, x, y, z));
          if (cell == cells_.end()) continue;
          for (const int index : cell->second) {
            const double d2 = (points_[static_cast<std::size_t>(index)] - place).squaredNorm();
            if (d2 <= radius_m * radius_m) visit(index, d2);
          }
        }
      }
    }
  }

  /// Nearest point within `radius_m` <= cell size, the first inserted of equals; -1: none.
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
  [[nodiscard]] std::uint64_t key(const Eigen::Vector3d& p, int dx, int dy, int dz) const {
    // 21 bits an axis: two million cells, wrapped; a wrapped neighbour fails the distance test.
    const auto part = [this](double value, int shift) {
      const auto cell = static_cast<std::int64_t>(std::floor(value / cell_m_)) + shift;
      return static_cast<std::uint64_t>(cell) & 0x1FFFFFU;
    };
    return part(p.x(), dx) << 42U | part(p.y(), dy) << 21U | part(p.z(), dz);
  }

  double cell_m_;
  std::vector<Eigen::Vector3d> points_;
  std::unordered_map<std::uint64_t, std::vector<int>> cells_;
};

}  // namespace roadbook
