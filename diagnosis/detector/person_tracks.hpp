#pragma once

#include <optional>
#include <vector>

#include "diagnosis/detector/person_detections.hpp"

namespace roadbook {

/// The detections of one pedestrian: indices, ascending in time, at most one a frame.
struct PersonTrack {
  std::vector<std::size_t> sightings;
};

/// Number of frames without a detection after which a track ends.
inline constexpr std::size_t kTrackGap = 6;

/// Position of a tracked pedestrian in a frame, interpolated linearly between the neighbouring
/// detections; no value before the second and after the last one.
[[nodiscard]] std::optional<Eigen::Vector2d> place_at(const SightingReadings& readings,
                                                      const PersonTrack& track,
                                                      std::size_t look);

/// Associates detections to tracks by the Mahalanobis distance between predicted and detected
/// positions, most likely pairs first, with a 99.9 % chi-squared gate. Pedestrians stand or walk;
/// their velocity decorrelates within seconds. Tracks of one detection are left out.
[[nodiscard]] std::vector<PersonTrack> person_tracks(const SightingReadings& readings);

}  // namespace roadbook
