#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "semantics/overhead/ground_model.hpp"
#include "semantics/people/person_search.hpp"

namespace roadbook {

struct PersonPlaceOptions {
  /// Standard deviation of the window's feet [px, for a person of 72 px].
  double sigma_foot_px = 3.6;
  double sigma_side_px = 2.0;     ///< of the window's middle, sideways [px, same scale]
  double sigma_tilt_rad = 0.004;  ///< of the vehicle's tilt against the ground: springs and pose
  double sigma_ground_m = 0.03;   ///< of the height of the ground at the feet
  /// Range of heights of people [m]. A detection is rejected if its height on the ground is outside
  /// by more than two standard deviations of its window.
  double min_height_m = 1.4;
  double max_height_m = 2.0;
  double mean_height_m = 1.72;
  double sigma_height_m = 0.12;
};

/// Ground contact of a person, in the frame of the vehicle whose camera detected it.
struct PlacedPerson {
  PersonBox box;
  double probability = 1.0;
  Eigen::Vector2d foot = Eigen::Vector2d::Zero();            ///< [m]
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  ///< [m^2]
};

/// Intersects the ray to the feet with the ground. The range also uses the prior of people's
/// heights (one Kalman update). The covariance includes the errors of window, vehicle tilt, ground
/// height and person height. Empty if the ray does not meet the ground within 100 m, or if the
/// height is outside the range for people. (The search itself only knows the plane of the wheels.)
[[nodiscard]] std::optional<PlacedPerson> place_on_ground(const PersonHypothesis& found,
                                                          const MountedCamera& mounted,
                                                          const Eigen::Isometry3d& T_map_vehicle,
                                                          const GroundModel& ground,
                                                          const PersonPlaceOptions& options = {});

/// Merges detections of one person by several cameras: window and probability of the most likely
/// one, feet averaged with their covariances. Detections of different cameras are merged if they
/// are within `within_m` or within three standard deviations; of several candidates the one with
/// the smallest Mahalanobis distance. Sorted by probability, highest first.
[[nodiscard]] std::vector<PlacedPerson> merge_cameras(std::vector<PlacedPerson> people,
                                                      double within_m = 0.7);

}  // namespace roadbook
