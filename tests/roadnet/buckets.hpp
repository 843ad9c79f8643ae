#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace roadbook::test {

/// Stores the indices of places by the square that contains each place.
class Buckets {
 public:
  explicit Buckets(double size_m) : size_m_(size_m) {}
  void insert(const Eigen::Vector2d& at, int index) { cells_[key(at, 0, 0)].push_back(index); }
  template <typename Visit>
  void visit(const Eigen::Vector2d& at, double radius_m, const Visit& visit) const {
    const int cells = static_cast<int>(std::ceil(radius_m / size_m_));
    for (int x = -cells; x <= cells; ++x)
      for (int y = -cells; y <= cells; ++y)
        if (const auto found = cells_.find(key(at, x, y)); found != cells_.end())
          for (const int index : found->second) visit(index);
  }

 private:
  [[nodiscard]] std::int64_t key(const Eigen::Vector2d& at, int dx, int dy) const {
    const auto cell = [this](double v, int d) {
      return static_cast<std::int64_t>(std::floor(v / size_m_)) + d;
    };
    return cell(at.x(), dx) * 40000003 + cell(at.y(), dy);
  }
  double size_m_;
  std::unordered_map<std::int64_t, std::vector<int>> cells_;
};

}  // namespace roadbook::test
