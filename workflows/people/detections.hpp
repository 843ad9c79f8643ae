#pragma once

#include <string>
#include <vector>

#include "drive/detections.hpp"
#include "mapping/map.hpp"
#include "mapping/store/map_file.hpp"
#include "speedmap/presence/visit_evidence.hpp"

namespace roadbook {

/// The people that a session saw, and the objects that blocked its view.
struct SessionSightings {
  std::string session;                 ///< its name
  std::vector<Detection> detections;   ///< by time
  std::vector<SightBlocker> blockers;  ///< map frame; empty if unknown
  std::vector<Look> looks{};  ///< by time; empty: at each keyframe, up to the range of the speed
                              ///< map
};

/// Groups the rows by the session in whose time they fall. The result has these sessions and the
/// sessions `observed`, in which the detector searched for people even if it found none.
/// `without_session` counts the rows outside all sessions. Throws InvalidOption for a name that is
/// not a session.
[[nodiscard]] std::vector<SessionSightings> by_session(const Map& map,
                                                       const std::vector<Detection>& detections,
                                                       const std::vector<std::string>& observed,
                                                       std::size_t& without_session);

/// Reads the sightings that earlier runs stored in the map (tables `detections`,
/// `sighting_sessions`, `sight_blockers`, `looks`). Leaves out sessions that the map no longer has.
[[nodiscard]] std::vector<SessionSightings> stored_sightings(const MapLayers& layers,
                                                             const Map& map);
void write_sightings(MapUpdate& update, const std::vector<SessionSightings>& sightings);

}  // namespace roadbook
