#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "diagnosis/detector/person_detections.hpp"
#include "diagnosis/inference/candidate.hpp"

namespace roadbook {

// On what a detector's answers may depend, for where it places feet and for whom it finds.

/// Somebody at a look.
struct SightMoment {
  double t_s = 0.0;
  double range_m = 0.0;      ///< from the camera
  double bearing_rad = 0.0;  ///< of the line of sight, from the vehicle's heading
  double speed = 0.0;        ///< of the vehicle [m/s]
  double yaw_rate = 0.0;     ///< [rad/s]
};
[[nodiscard]] SightMoment sight_moment(const LookPose& look,
                                       const Eigen::Vector2d& eye,
                                       const Eigen::Vector2d& foot);

/// Candidate of the declared effect of that name.
[[nodiscard]] Candidate detector_effect(const std::string& name);
/// "HOOK ~ COVARIATE".
[[nodiscard]] Candidate detector_term(const std::string& hook,
                                      const std::string& covariate,
                                      const std::string& unit,
                                      double tau);
/// Smooth functions of a covariate ("constant", "range", "bearing", "speed", "turn rate", "time"),
/// a column each: polynomials of mean 0 scaled to unit variance, cosine and sine of the bearing;
/// zero where it hardly varies.
[[nodiscard]] Eigen::MatrixXd detector_terms(const std::vector<SightMoment>& moments,
                                             const std::string& covariate);
/// Values of a covariate, for plots; "bearing" in radians.
[[nodiscard]] std::vector<double> detector_covariate(const std::vector<SightMoment>& moments,
                                                     const std::string& covariate);

}  // namespace roadbook
