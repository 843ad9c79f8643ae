#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapping/localisation/landmark_matches.hpp"
#include "mapping/map.hpp"

namespace roadbook {

/// A landmark that other sessions of the map saw, and how often a drive should see it again: each
/// of its views has a chance where the drive's nearest keyframe looks at it alike.
struct LandmarkChance {
  int landmark = 0;
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();
  double expected = 0.0;  ///< sightings, by how often others are seen from such distances and sides
  int sightings = 0;      ///< of those that were expected
  bool found = false;     ///< seen at all, or a landmark like it nearby
  int views = 0;          ///< by the others
  double range_m = 0.0;   ///< of the nearest view that has a chance
  bool ground = false;
  double chance = 0.0;  ///< of being found, as others are (`judge_chances`)
};

struct LandmarkChanceOptions {
  double near_m = 1.5;     ///< keyframes farther apart see nothing alike
  double turn_rad = 0.5;   ///< nor those that are turned by more
  double side_rad = 0.35;  ///< nor lines of sight that differ by more
  double margin_px = 8.0;
  int fewest_views = 4;          ///< of a landmark
  double least_parallax = 0.05;  ///< [rad] of its views: less leaves its place open
  double least_expected = 1.0;   ///< sightings
  int trusted = 10;  ///< landmarks that a keyframe must have found for its pose to be believed
};

/// Landmarks of the other sessions that `session` should see again, in the order of the map.
/// `twins`: what it found again elsewhere (`landmark_twins`). Deterministic.
[[nodiscard]] std::vector<LandmarkChance> landmark_chances(
    const Map& map,
    int session,
    const std::vector<LandmarkTwin>& twins,
    const LandmarkChanceOptions& options = {});

/// Fills `chance`: logistic regression of `found` on expected sightings, range, number of views and
/// whether it is ground, over those with `of_use` not 0 (same length).
void judge_chances(const std::vector<std::uint8_t>& of_use, std::vector<LandmarkChance>& chances);

}  // namespace roadbook
