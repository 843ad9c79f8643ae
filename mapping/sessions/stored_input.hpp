#pragma once

#include <vector>

#include "mapping/joined_tracks.hpp"
#include "mapping/map.hpp"

namespace roadbook {

/// The input of the stages after odometry, from what a map stores instead of from recordings.
struct StoredInput {
  /// Keyframe by keyframe as in the map. Its features are the observations, with the descriptors of
  /// their landmarks, then the corners that no landmark explains. The odometry frame is the map's.
  MappingInput input;
  std::vector<TrackMatch> same;        ///< tracks of one landmark, which sessions and cameras split
  std::vector<int> landmark_of_track;  ///< of each track in `input`
};

/// Turns the stored observations of `map` into tracks: one for each landmark, session and camera
/// that saw it. Linear in the number of observations.
[[nodiscard]] StoredInput stored_input(const Map& map);

}  // namespace roadbook
