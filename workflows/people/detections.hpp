#pragma once

#include <string>
#include <vector>

#include "drive/detections.hpp"
#include "mapping/map.hpp"
#include "mapping/store/map_file.hpp"
#include "speedmap/presence/visit_evidence.hpp"

namespace roadbook {

/// What a session saw of people, and what stood in its way.
struct SessionSightings {
  std::string session;                 ///< its name
  std::vector<Detection> detections;   ///< by time
  std::vector<SightBlocker> blockers;  ///< map frame; where they are known
  std::vector<Look> looks{};  ///< by time; empty: at every keyframe, out to the speed map's range
};

/// The rows by the sessions whose time they fall into, of those sessions and of `observed` (names:
/// people were looked for even where nobody was found). Rows of no session are counted in
/// `without_session`. Throws InvalidOption for a name that is no session.
[[nodiscard]] std::vector<SessionSightings> by_session(const Map& map,
                                                       const std::vector<Detection>& detections,
                                                       const std::vector<std::string>& observed,
                                                       std::size_t& without_session);

/// What earlier runs have left in the map (tables `detections`, `sighting_sessions`,
/// `sight_blockers`, `looks`); sessions that the map no longer has are left out.
[[nodiscard]] std::vector<SessionSightings> stored_sightings(const MapLayers& layers,
                                                             const Map& map);
void write_sightings(MapUpdate& update, const std::vector<SessionSightings>& sightings);

}  // namespace roadbook
