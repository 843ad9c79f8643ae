#pragma once

#include <vector>

#include "mapping/joined_tracks.hpp"
#include "mapping/map.hpp"
#include "mapping/pipeline/map_options.hpp"
#include "mapping/sessions/place_session.hpp"

namespace roadbook {

/// A map and a further session, joined by the landmarks that both see.
struct JoinedSession {
  MappingInput input;              ///< keyframes of the map, then those of the session
  std::size_t first_keyframe = 0;  ///< of the session
  std::vector<Eigen::Isometry3d> T_map_vehicle;  ///< of each keyframe
  std::vector<int> piece;                        ///< of each keyframe
  std::vector<JoinedTrack> tracks;               ///< those of the map first, with its positions

  [[nodiscard]] bool has_session(const JoinedTrack& track) const;
};

/// Joins the stored observations of `map` with the tracks of `drive` (one session). A track of the
/// drive joins the landmark that most of its key points were localised with. Tracks without one are
/// searched in the nearest images of the map, whose corners without a landmark are stored. Tracks
/// with a view of the session are triangulated again. `same_in_drive`: tracks of the drive that
/// show one corner, by its own keyframes and tracks. Deterministic on any number of threads.
[[nodiscard]] JoinedSession join_session(const Map& map,
                                         const MappingInput& drive,
                                         const PlacedSession& placed,
                                         const MapOptions& options,
                                         const std::vector<TrackMatch>& same_in_drive = {});

/// Index of the landmark of `map` to which a track of `joined` belongs; -1: none.
[[nodiscard]] std::vector<int> landmarks_of_tracks(const Map& map,
                                                   const std::vector<JoinedTrack>& tracks);

}  // namespace roadbook
