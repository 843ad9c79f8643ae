#pragma once

#include <vector>

#include "semantics/labels/labels.hpp"

namespace roadbook {

// Labels that were found in several images test the map: where its poses are right, the images put
// the same thing in the same place.

struct LabelDisagreement {
  std::int64_t id = 0;
  LabelAnchor anchor;                               ///< of the further image
  Eigen::Vector2d apart = Eigen::Vector2d::Zero();  ///< further image minus the label's own [m]
  double sigmas = 0.0;                              ///< in standard deviations of both places
};

struct LabelAgreement {
  std::vector<LabelDisagreement> sightings;  ///< by id
  double median_sigmas = 0.0;
  /// Chance of as much in a map whose covariances are right, when all its sightings go astray
  /// together, as those of one pass do: one pair of coordinates, whatever their number. 1 without
  /// sightings.
  double chance = 1.0;
  double median_m = 0.0;  ///< distance apart

  /// The poses say more than the labels bear out: something bends the map.
  [[nodiscard]] bool contradicts() const { return chance < 1e-3; }
};

[[nodiscard]] LabelAgreement agreement_of(const Map& map, const std::vector<Label>& labels);

}  // namespace roadbook
