#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace roadbook {

/// A rectangle on the ground, map frame, for example a parking space. `heading` points along its
/// length [rad].
struct OrientedBox {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double heading = 0.0;
  double length_m = 5.0;
  double width_m = 2.5;

  [[nodiscard]] double area() const { return length_m * width_m; }
  /// Counter-clockwise, beginning with the front right corner.
  [[nodiscard]] std::array<Eigen::Vector2d, 4> corners() const;
  [[nodiscard]] bool contains(const Eigen::Vector2d& p) const;
  bool operator==(const OrientedBox&) const = default;
};

/// Area of the intersection over area of the union, 0 to 1.
[[nodiscard]] double intersection_over_union(const OrientedBox& a, const OrientedBox& b);

/// Box from three clicks: both ends of one side along its length, and a point on the opposite side.
/// The heading points from the first to the second click.
[[nodiscard]] OrientedBox box_of_clicks(const Eigen::Vector2d& begin,
                                        const Eigen::Vector2d& end,
                                        const Eigen::Vector2d& opposite);

/// Greedy non-maximum suppression: visits boxes by descending score (equal scores in the given
/// order) and keeps those that overlap no kept box by more than `max_overlap`, at most `most`.
/// Returns their indices, best first.
[[nodiscard]] std::vector<std::size_t> non_maximum_suppression(std::span<const OrientedBox> boxes,
                                                               std::span<const double> scores,
                                                               double max_overlap,
                                                               std::size_t most = SIZE_MAX);

/// Greedy one-to-one matching of found boxes to true ones, largest overlap first. Returns for each
/// found box the index of its true box, or -1.
[[nodiscard]] std::vector<int> match_boxes(std::span<const OrientedBox> found,
                                           std::span<const OrientedBox> truth,
                                           double min_overlap);

}  // namespace roadbook
