#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "base/cell_grid.hpp"
#include "mapping/map.hpp"

namespace roadbook {

/// A landmark as localisation uses it.
struct KnownLandmark {
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();
  /// Of `p_map` [m^2], axes of the map, given the poses.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  Eigen::Vector3d to_viewer = Eigen::Vector3d::Zero();  ///< mean direction to the cameras, unit
  double least_cosine = 1.0;  ///< of the angle between `to_viewer` and one of these directions
  double nearest_m = 0.0;     ///< least distance from which a camera saw it
  double farthest_m = 0.0;    ///< largest such distance
  double weight = 1.0;        ///< probability that it is still there and can be seen
  bool used = false;          ///< seen by one of the chosen sessions, and of enough weight
};

struct NearLandmarksOptions {
  double reach_m = 4.0;              ///< between the vehicle and the keyframes that saw a landmark
  std::size_t max_landmarks = 3000;  ///< those with the most views from there, times weight, stay
  double angle_rad = 0.6;            ///< beyond the directions from which a landmark was seen
  double distance_factor = 2.0;      ///< beyond the distances from which it was seen

  /// Throws InvalidOption.
  void check() const;
};

/// The landmarks of a map, and from which poses they were seen [metric-semantic maps, section
/// IV-C: "landmarks in the vicinity"]. Keeps a reference to the map. Const member functions are
/// safe to call concurrently.
class LandmarkIndex {
 public:
  /// `sessions`: names of the sessions whose views count; empty: all. `least_weight`: landmarks of
  /// less weight (`landmark_weights`) are not used. Throws InvalidOption for a name that the map
  /// does not have.
  explicit LandmarkIndex(const Map& map,
                         const std::vector<std::string>& sessions = {},
                         double least_weight = 0.0);

  [[nodiscard]] const Map& map() const { return map_; }
  /// By index in `Map::landmarks`.
  [[nodiscard]] const std::vector<KnownLandmark>& landmarks() const { return landmarks_; }
  /// Landmarks that one of the map's keyframes saw, ascending.
  [[nodiscard]] const std::vector<int>& seen_from(int keyframe) const;
  /// Keyframes that saw a landmark, ascending.
  [[nodiscard]] const std::vector<int>& viewers(int landmark) const;
  /// Keyframes of the chosen sessions within `radius_m` of a place, ascending.
  [[nodiscard]] std::vector<int> keyframes_near(const Eigen::Vector3d& p_map,
                                                double radius_m) const;
  /// Keyframe of the chosen sessions nearest to a place, at most 40 m away; -1: none.
  [[nodiscard]] int nearest_keyframe(const Eigen::Vector3d& p_map) const;

  /// Landmarks that a vehicle at this pose may see, ascending: seen from keyframes near it, with
  /// directions and distances like those of their views.
  [[nodiscard]] std::vector<int> near(const Eigen::Isometry3d& T_map_vehicle,
                                      const NearLandmarksOptions& options = {}) const;

 private:
  const Map& map_;
  std::vector<KnownLandmark> landmarks_;
  std::vector<std::vector<int>> seen_from_;
  std::vector<std::vector<int>> viewers_;
  CellGrid<int> keyframes_;
};

}  // namespace roadbook
