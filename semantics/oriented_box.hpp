#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace roadbook {

/// A rectangle on the ground, map frame: a parking space and the like. `heading` points along its
/// length [rad]; `length_m` and `width_m` are its sides.
struct OrientedBox {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double heading = 0.0;
  double length_m = 5.0;
  double width_m = 2.5;

  [[nodiscard]] double area() const { return length_m * width_m; }
  /// Counter-clockwise, from the one ahead on the right.
  [[nodiscard]] std::array<Eigen::Vector2d, 4> corners() const;
  [[nodiscard]] bool contains(const Eigen::Vector2d& p) const;
  bool operator==(const OrientedBox&) const = default;
};

/// Area common to both over the area that either covers, 0 to 1.
[[nodiscard]] double intersection_over_union(const OrientedBox& a, const OrientedBox& b);

/// Box from three clicks: two ends of one side along its length, and a point on the opposite side.
/// The order of the first two gives the heading.
[[nodiscard]] OrientedBox box_of_clicks(const Eigen::Vector2d& begin,
                                        const Eigen::Vector2d& end,
                                        const Eigen::Vector2d& opposite);

/// Indices of the boxes that stay when of each two that overlap by more than `max_overlap` the one
/// with the lower score goes; best first, equal scores in the order given; at most `most`.
[[nodiscard]] std::vector<std::size_t> non_maximum_suppression(std::span<const OrientedBox> boxes,
                                                               std::span<const double> scores,
                                                               double max_overlap,
                                                               std::size_t most = SIZE_MAX);

/// Greedy one-to-one matching of found boxes to true ones by overlap, largest first; for each found
/// box the index of its true one, or -1.
[[nodiscard]] std::vector<int> match_boxes(std::span<const OrientedBox> found,
                                           std::span<const OrientedBox> truth,
                                           double min_overlap);

}  // namespace roadbook
