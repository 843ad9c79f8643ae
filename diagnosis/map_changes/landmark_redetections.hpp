#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapping/localisation/landmark_matches.hpp"
#include "mapping/map.hpp"

namespace roadbook {

/// A landmark of other sessions, and how often a drive should detect it again. Each earlier view
/// counts with the detection probability of a similar view of the drive's most similar keyframe.
struct LandmarkRedetection {
  int landmark = 0;
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();
  double expected =
      0.0;  ///< expected redetections, by the rates of other landmarks at similar ranges and angles
  int sightings = 0;     ///< redetections among the expected views
  bool found = false;    ///< detected at all, or matched to a similar landmark nearby
  int views = 0;         ///< in the other sessions
  double range_m = 0.0;  ///< of the nearest expected view
  bool ground = false;
  double chance = 0.0;  ///< probability of `found`, see `fit_redetection_probabilities`
};

struct RedetectionOptions {
  double near_m = 1.5;     ///< largest distance of similar keyframes
  double turn_rad = 0.5;   ///< largest difference of their headings
  double side_rad = 0.35;  ///< largest angle between lines of sight
  double margin_px = 8.0;
  int fewest_views = 4;          ///< in other sessions
  double least_parallax = 0.05;  ///< [rad] of its views; with less its position is uncertain
  double least_expected = 1.0;   ///< redetections
  int trusted = 10;              ///< redetections that a keyframe needs, or its pose is not trusted
};

/// Landmarks of other sessions that `session` should detect again, in the order of the map.
/// `twins`: landmarks that it matched at another place (`landmark_twins`). Deterministic.
[[nodiscard]] std::vector<LandmarkRedetection> landmark_redetections(
    const Map& map,
    int session,
    const std::vector<LandmarkTwin>& twins,
    const RedetectionOptions& options = {});

/// Sets `chance` by a logistic regression of `found` on log expected redetections, log range, log
/// number of views and whether the landmark is on the ground. Only landmarks with a nonzero
/// `of_use` (same length) are used for the fit.
void fit_redetection_probabilities(const std::vector<std::uint8_t>& of_use,
                                   std::vector<LandmarkRedetection>& chances);

}  // namespace roadbook
