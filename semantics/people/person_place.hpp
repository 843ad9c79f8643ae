#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "semantics/overhead/ground_model.hpp"
#include "semantics/people/person_search.hpp"

namespace roadbook {

struct PersonPlaceOptions {
  /// Of a found window's feet, standard deviation [px of 72 a person].
  double sigma_foot_px = 3.6;
  double sigma_side_px = 2.0;     ///< of its middle, across
  double sigma_tilt_rad = 0.004;  ///< of the vehicle's springs and the pose against the ground
  double sigma_ground_m = 0.03;   ///< of the ground's height under the feet
  /// People's heights [m]; what would be shorter or taller there by more than two standard
  /// deviations of its window is nobody.
  double min_height_m = 1.4;
  double max_height_m = 2.0;
  double mean_height_m = 1.72;
  double sigma_height_m = 0.12;
};

/// Feet on the ground, in the frame of the vehicle that saw them.
struct PlacedPerson {
  PersonBox box;
  double probability = 1.0;
  Eigen::Vector2d foot = Eigen::Vector2d::Zero();            ///< [m]
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  ///< [m^2]
};

/// Where the ray to the feet meets the ground; empty where it does not within 100 m, or where what
/// stands there is too short or too tall for a person (the search knows no ground, only the plane
/// of the wheels). How far
/// off somebody is, feet and height tell together. The covariance has the window's error, the
/// vehicle's tilt, the ground's height and that of people.
[[nodiscard]] std::optional<PlacedPerson> place_on_ground(const PersonHypothesis& found,
                                                          const MountedCamera& mounted,
                                                          const Eigen::Isometry3d& T_map_vehicle,
                                                          const GroundModel& ground,
                                                          const PersonPlaceOptions& options = {});

/// Sightings of the same person by several cameras are one: the likeliest one's window and
/// probability, the feet of all, each weighed by its covariance. The same are those of different
/// cameras within `within_m` of one another, or within three standard deviations; of several the
/// nearest in these. Likeliest first.
[[nodiscard]] std::vector<PlacedPerson> merge_cameras(std::vector<PlacedPerson> people,
                                                      double within_m = 0.7);

}  // namespace roadbook
