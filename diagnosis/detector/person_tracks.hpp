#pragma once

#include <optional>
#include <vector>

#include "diagnosis/detector/person_detections.hpp"

namespace roadbook {

/// Sightings of one person, as far as can be told: indices, ascending in time, one a look at most.
struct PersonTrack {
  std::vector<std::size_t> sightings;
};

/// Looks that may pass without somebody being found before they count as gone.
inline constexpr std::size_t kTrackGap = 6;

/// Where a person was at a look, on the line between the sightings before and at it or after; empty
/// before the second and after the last.
[[nodiscard]] std::optional<Eigen::Vector2d> place_at(const SightingReadings& readings,
                                                      const PersonTrack& track,
                                                      std::size_t look);

/// Sightings strung together by the Mahalanobis distance between where somebody is expected and
/// where somebody is found, likeliest pairs first, none beyond chi-squared's 99.9 %. People stand
/// or walk with a velocity that is forgotten within seconds. Tracks of one sighting are left out.
[[nodiscard]] std::vector<PersonTrack> person_tracks(const SightingReadings& readings);

}  // namespace roadbook
