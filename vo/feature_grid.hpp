#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

namespace roadbook {

/// A grid over the pixels of features, which finds the features near a pixel without visiting all.
/// Keeps a reference to `pixels`, which must outlive it.
class FeatureGrid {
 public:
  FeatureGrid(const std::vector<Eigen::Vector2f>& pixels, int width, int height)
      : pixels_(pixels), columns_(width / kCell + 1), rows_(height / kCell + 1) {
    std::vector<int> counts(static_cast<std::size_t>(columns_ * rows_) + 1);
    for (const auto& p : pixels) ++counts[cell_of(p) + 1];
    for (std::size_t i = 1; i < counts.size(); ++i) counts[i] += counts[i - 1];
    begin_ = counts;
    items_.resize(pixels.size());
    for (std::size_t i = 0; i < pixels.size(); ++i)
      items_[static_cast<std::size_t>(counts[cell_of(pixels[i])]++)] = static_cast<int>(i);
  }

  /// Calls visit(index) for every feature in the square of half width `radius` [px] around
  /// `centre`.
  template <typename Visit>
  void for_each_near(const Eigen::Vector2d& centre, double radius, const Visit& visit) const {
    const int c0 = clamp_cell(centre.x() - radius, columns_);
    const int c1 = clamp_cell(centre.x() + radius, columns_);
    const int r0 = clamp_cell(centre.y() - radius, rows_);
    const int r1 = clamp_cell(centre.y() + radius, rows_);
    for (int r = r0; r <= r1; ++r)
      for (int c = c0; c <= c1; ++c) {
        const auto cell = static_cast<std::size_t>(r * columns_ + c);
        for (int i = begin_[cell]; i < begin_[cell + 1]; ++i) {
          const int item = items_[static_cast<std::size_t>(i)];
          const Eigen::Vector2f& p = pixels_[static_cast<std::size_t>(item)];
          if (std::abs(p.x() - centre.x()) <= radius && std::abs(p.y() - centre.y()) <= radius)
            visit(item);
        }
      }
  }

 private:
  static constexpr int kCell = 16;

  static int clamp_cell(double x, int count) {
    return static_cast<int>(std::clamp(std::floor(x / kCell), 0.0, static_cast<double>(count - 1)));
  }
  std::size_t cell_of(const Eigen::Vector2f& p) const {
    return static_cast<std::size_t>(clamp_cell(p.y(), rows_) * columns_ +
                                    clamp_cell(p.x(), columns_));
  }

  const std::vector<Eigen::Vector2f>& pixels_;
  int columns_;
  int rows_;
  std::vector<int> begin_;
  std::vector<int> items_;
};

}  // namespace roadbook
