#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "mapping/map.hpp"
#include "mapping/map_file.hpp"
#include "speedmap/visit_evidence.hpp"

namespace roadbook {

/// Somebody seen, in the frame of the vehicle that saw them: stays right when the map is optimised
/// again.
struct Detection {
  std::int64_t t_ns = 0;
  double x_m = 0.0;  ///< of the feet, ahead of the rear axle
  double y_m = 0.0;  ///< to the left
  double sigma_m = 0.3;
  double probability = 1.0;
  /// Of (x, y) where it is known [m^2]: xx, xy, yy; zeros: sigma_m alone.
  std::array<double, 3> covariance{};
};

/// An instant at which people were looked for, and how far the ground was seen.
struct Look {
  std::int64_t t_ns = 0;
  /// In equal sectors counter-clockwise from the vehicle's heading, steps of 0.1 m.
  std::vector<std::uint8_t> reach_dm;
};

/// What a session saw of people, and what stood in its way.
struct SessionSightings {
  std::string session;                 ///< its name
  std::vector<Detection> detections;   ///< by time
  std::vector<SightBlocker> blockers;  ///< map frame; where they are known
  std::vector<Look> looks{};  ///< by time; empty: at every keyframe, out to the speed map's range
};

/// Rows of a detections table (docs/speed_map.md): `#timestamp [ns],x [m],y [m],sigma [m],
/// probability [-]`, the last two optional, in any order of time. Throws BadInput with all faults.
[[nodiscard]] std::vector<Detection> read_detections(const std::filesystem::path& file);

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
