#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapping/map.hpp"

namespace roadbook {

/// A cross-session match ("twin"): a corner that one session and the other sessions of a map both
/// triangulated. A moved object gives a shift between the two positions.
struct LandmarkTwin {
  Eigen::Vector3d then = Eigen::Vector3d::Zero();   ///< position by the other sessions [m, map]
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< position by this session minus `then` [m]
  double sigma_m = 0.0;  ///< standard deviation of the shift along the rays, from the parallax
  int landmark = 0;      ///< index of the landmark that the other sessions observed
  int again = 0;         ///< index of the landmark that this session observed; may be the same
};

struct LandmarkTwinOptions {
  double radius_m = 1.2;     ///< searched around a landmark that the map did not join
  int max_hamming = 120;     ///< largest distance of descriptors, of 512 bits
  double max_ratio = 0.8;    ///< nearest over second-nearest descriptor distance
  double max_sigma_m = 0.1;  ///< twins with a larger `sigma_m` are left out
  double align_m = 8.0;      ///< radius of the twins whose median shift is subtracted
  double static_m = 0.15;    ///< only shifts up to this count for the median
  std::size_t fewest = 10;   ///< twins that the median needs; a twin with fewer is left out
  bool aligned = true;       ///< false: does not subtract the median
};

/// Finds the cross-session matches of `session` with all other sessions. A landmark that both sides
/// observed is triangulated from the rays of each side. Other landmarks match if their descriptors
/// are each other's nearest within `radius_m`. From each shift the median shift of the twins around
/// it is subtracted, because an error of the poses moves all of these twins by the same vector.
/// Deterministic.
[[nodiscard]] std::vector<LandmarkTwin> landmark_twins(const Map& map,
                                                       int session,
                                                       const LandmarkTwinOptions& options = {});

/// Leaves out twins above `max_sigma_m` and subtracts the median shift. `twins`: a result of
/// `landmark_twins` with `aligned` false.
[[nodiscard]] std::vector<LandmarkTwin> aligned_twins(std::vector<LandmarkTwin> twins,
                                                      const LandmarkTwinOptions& options = {});

}  // namespace roadbook
