#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mapping/map.hpp"

namespace roadbook {

// What differs between two maps of a place, A and B. B is moved by one rigid motion onto A, so that
// maps with other map frames can be compared. Positions are those of A's map frame [m].

/// A keyframe that both maps have: the same drive (by digest) and the same stamp.
struct ComparedPose {
  int a = 0;  ///< keyframe of map A
  int b = 0;  ///< keyframe of map B
  double distance_m = 0.0;
  double angle_rad = 0.0;  ///< between the two orientations
};

/// Counts of things that both maps have, or one alone.
struct CommonCounts {
  std::size_t both = 0;
  std::size_t only_a = 0;
  std::size_t only_b = 0;
};

struct LandmarkComparison : CommonCounts {
  std::size_t compared = 0;  ///< of `both`: their pieces are those that the motion aligns
  std::size_t judged = 0;    ///< of `compared`: both covariances are known
  /// Of `judged`: apart by more than 3 sigma + 5 cm, sigma along the line between both positions.
  std::size_t moved = 0;
  std::optional<double> median_m;              ///< over `compared`
  std::vector<int> ids_only_a;                 ///< in A, ascending
  std::vector<int> ids_only_b;                 ///< in B, ascending
  std::vector<std::pair<int, int>> moved_ids;  ///< in A and in B
};

struct MapComparison {
  std::vector<std::string> common_sessions;  ///< names in A, in A's order
  std::vector<std::string> sessions_only_a;
  std::vector<std::string> sessions_only_b;
  /// Motion that takes coordinates of map B to those of map A; empty without common poses.
  std::optional<Eigen::Isometry3d> T_a_b;
  std::vector<ComparedPose> poses;        ///< in the order of A
  std::size_t poses_of_other_pieces = 0;  ///< common, but not joined with those compared
  /// Empty without common poses.
  std::optional<double> median_m;
  std::optional<double> p95_m;
  std::optional<std::size_t> worst;  ///< index into `poses`
  LandmarkComparison landmarks;
  CommonCounts loops;  ///< accepted ones, by their two keyframes
};

/// Compares the maps themselves. The motion is the least-squares one of all common poses, in closed
/// form: over six points of each vehicle, 1 m from its origin along each axis and against it, so
/// that orientations count and a straight road leaves no rotation open. If a map has pieces that
/// nothing joins, the pair of pieces with the most common poses is compared.
///
/// Landmarks belong together if observations of both (same drive, stamp and camera) lie within 0.5
/// px; of several candidates the pair with the most such observations.
[[nodiscard]] MapComparison compare_maps(const Map& a, const Map& b);

}  // namespace roadbook
