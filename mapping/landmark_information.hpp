#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "base/se3.hpp"
#include "mapping/map.hpp"

namespace roadbook {

/// What an observation says, whitened by its standard deviation.
struct ObservationTerms {
  Eigen::Matrix<double, 2, 6> J_pose;  ///< by the right perturbation of T_map_vehicle
  Matrix23d J_point;                   ///< by the landmark, map axes
};

/// Empty where the camera does not see the landmark.
[[nodiscard]] std::optional<ObservationTerms> terms_of(const Map& map, const Observation& o);

/// Information of each landmark given the poses [1/m^2, map axes], if the errors of its
/// observations are independent.
[[nodiscard]] std::vector<Eigen::Matrix3d> landmark_information(const Map& map);

}  // namespace roadbook
