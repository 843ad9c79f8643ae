#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "diagnosis/detector/person_detections.hpp"
#include "diagnosis/inference/candidate.hpp"

namespace roadbook {

// Covariates of a pedestrian detector's errors: of its ground positions and of its recall.

/// Geometry and motion of one pedestrian in one detector frame.
struct DetectionContext {
  double t_s = 0.0;
  double range_m = 0.0;      ///< from the camera
  double bearing_rad = 0.0;  ///< of the line of sight relative to the vehicle's heading
  double speed = 0.0;        ///< of the vehicle [m/s]
  double yaw_rate = 0.0;     ///< [rad/s]
};
[[nodiscard]] DetectionContext detection_context(const DetectorFrame& look,
                                                 const Eigen::Vector2d& eye,
                                                 const Eigen::Vector2d& foot);

/// Candidate for the catalogued effect `name`.
[[nodiscard]] Candidate detector_effect(const std::string& name);
/// Candidate for the generic effect "HOOK ~ COVARIATE".
[[nodiscard]] Candidate detector_term(const std::string& hook,
                                      const std::string& covariate,
                                      const std::string& unit,
                                      double tau);
/// Basis functions of a covariate ("constant", "range", "bearing", "speed", "turn rate", "time"),
/// one column each: polynomials with mean 0 and variance 1; cosine and sine of the bearing. 0 if
/// the covariate hardly varies.
[[nodiscard]] Eigen::MatrixXd detector_terms(const std::vector<DetectionContext>& moments,
                                             const std::string& covariate);
/// Values of a covariate, for plots; "bearing" in radians.
[[nodiscard]] std::vector<double> detector_covariate(const std::vector<DetectionContext>& moments,
                                                     const std::string& covariate);

}  // namespace roadbook
