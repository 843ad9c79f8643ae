#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "semantics/ground_model.hpp"
#include "semantics/person_search.hpp"

namespace roadbook {

struct PersonPlaceOptions {
  /// Of a found window's feet, standard deviation [px of 72 a person].
  double sigma_foot_px = 3.6;
  double sigma_side_px = 2.0;     ///< of its middle, across
  double sigma_tilt_rad = 0.004;  ///< of the vehicle's springs and the pose against the ground
  double sigma_ground_m = 0.03;   ///< of the ground's height under the feet
};

/// Feet on the ground, in the frame of the vehicle that saw them.
struct PlacedPerson {
  PersonBox box;
  double probability = 1.0;
  Eigen::Vector2d foot = Eigen::Vector2d::Zero();            ///< [m]
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  ///< [m^2]
};

/// Where the ray to the feet meets the ground; empty where it does not within 100 m. The
/// covariance has the window's error, the vehicle's tilt and the ground's height.
[[nodiscard]] std::optional<PlacedPerson> place_on_ground(const PersonHypothesis& found,
                                                          const MountedCamera& mounted,
                                                          const Eigen::Isometry3d& T_map_vehicle,
                                                          const GroundModel& ground,
                                                          const PersonPlaceOptions& options = {});

/// Of the same person seen by several cameras the likeliest sighting stays: those of other cameras
/// within `within_m` of it, or within three standard deviations, go. Likeliest first.
[[nodiscard]] std::vector<PlacedPerson> merge_cameras(std::vector<PlacedPerson> people,
                                                      double within_m = 0.7);

}  // namespace roadbook
