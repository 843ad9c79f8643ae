#pragma once

#include <vector>

#include "semantics/labels/labels.hpp"

namespace roadbook {

// Tests a map with labels that were measured in several images. If the poses are right, all images
// place a label at the same position.

struct LabelDisagreement {
  std::int64_t id = 0;
  LabelAnchor anchor;                               ///< the other image
  Eigen::Vector2d apart = Eigen::Vector2d::Zero();  ///< position from it minus own position [m]
  double sigmas = 0.0;  ///< Mahalanobis distance, covariances of both positions added
};

struct LabelAgreement {
  std::vector<LabelDisagreement> sightings;  ///< in the order of the labels
  double median_sigmas = 0.0;
  /// p-value of `median_sigmas` if the covariances of the map are right: tail of a chi-square
  /// distribution with 2 degrees of freedom. Errors of one session are correlated, so all sightings
  /// count as one pair of coordinates. 1 without sightings.
  double chance = 1.0;
  double median_m = 0.0;  ///< median distance

  /// The sightings disagree by more than the covariances of the poses allow: the map is distorted.
  [[nodiscard]] bool contradicts() const { return chance < 1e-3; }
};

/// Sightings whose covariance the map does not know are left out: they prove nothing.
[[nodiscard]] LabelAgreement agreement_of(const Map& map, const std::vector<Label>& labels);

}  // namespace roadbook
