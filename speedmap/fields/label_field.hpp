#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace roadbook {

// The labels of a map as functions of the plane: the signed distance to each outline.

/// The outline of a label in the map's plane.
struct LabelledOutline {
  std::optional<std::int64_t> id;  ///< empty: the outline has no number
  std::string kind;                ///< class
  double sigma_m = 0.0;            ///< standard deviation of the outline's position; NaN: unknown
  std::vector<Eigen::Vector2d> corners;  ///< [m, map frame]; either direction, open or closed
};

/// A label near a point.
struct LabelAt {
  const LabelledOutline* label = nullptr;
  double distance_m = 0.0;  ///< to the outline; negative within it
  /// By x and y of the map frame: a unit vector, outward. It jumps where two edges are equally
  /// near.
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
};

/// Finds the labels near a point. Immutable; safe to share between threads.
class LabelField {
 public:
  /// Outlines with fewer than three corners are left out. `reach_m`: labels farther away are not
  /// told. Throws InvalidOption for a reach that is not above 0, or corners that are not finite.
  explicit LabelField(std::vector<LabelledOutline> labels, double reach_m = 5.0);

  /// The labels within reach, nearest first. Cost grows with the edges of the labels near the
  /// point, not with the size of the map.
  void at(const Eigen::Vector2d& p, std::vector<LabelAt>& found) const;

  [[nodiscard]] const std::vector<LabelledOutline>& labels() const { return labels_; }
  [[nodiscard]] double reach_m() const { return reach_m_; }

 private:
  struct Box {
    Eigen::Vector2d low, high;
  };

  std::vector<LabelledOutline> labels_;
  std::vector<Box> boxes_;
  double reach_m_;
  Eigen::Vector2d low_ = Eigen::Vector2d::Zero();
  double bucket_m_ = 1.0;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::vector<std::uint32_t>> buckets_;  ///< labels within reach of the bucket
};

}  // namespace roadbook
