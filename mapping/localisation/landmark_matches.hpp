#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapping/map.hpp"

namespace roadbook {

/// One thing, seen at one place by a session and at another by the others.
struct LandmarkTwin {
  Eigen::Vector3d then = Eigen::Vector3d::Zero();   ///< by the other sessions, map frame [m]
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< of where this session sees it [m]
  double sigma_m = 0.0;                             ///< of the shift along the rays, by parallax
  int landmark = 0;                                 ///< of the map, that the others saw
  int again = 0;  ///< that the session sees; the same where it was joined
};

struct LandmarkTwinOptions {
  double radius_m = 1.2;     ///< searched about a landmark that was not joined
  int max_hamming = 120;     ///< of 512 bits
  double max_ratio = 0.8;    ///< of the distance to the second nearest
  double max_sigma_m = 0.1;  ///< of a twin
  double align_m = 8.0;      ///< whose twins tell how the session's poses lie here
  double static_m = 0.15;    ///< shifts up to this do
  std::size_t fewest = 10;   ///< that do so
  bool aligned = true;       ///< false: shifts as they are, errors of poses included
};

/// Landmarks of `session` and of the others that show the same thing: joined ones by the rays of
/// either side, the rest by descriptors that are each other's nearest. Each shift is
/// relative to the median shift of the twins around it: an error of the poses moves all of these
/// twins by the same vector. Deterministic.
[[nodiscard]] std::vector<LandmarkTwin> landmark_twins(const Map& map,
                                                       int session,
                                                       const LandmarkTwinOptions& options = {});

/// Of twins as they are (`aligned` false) those within `max_sigma_m`, aligned.
[[nodiscard]] std::vector<LandmarkTwin> aligned_twins(std::vector<LandmarkTwin> twins,
                                                      const LandmarkTwinOptions& options = {});

}  // namespace roadbook
