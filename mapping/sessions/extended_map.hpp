#pragma once

#include <optional>

#include "mapping/map.hpp"
#include "mapping/pipeline/map_options.hpp"
#include "mapping/pipeline/map_stages.hpp"
#include "mapping/sessions/join_session.hpp"
#include "mapping/sessions/place_session.hpp"

namespace roadbook {

/// The map with a further session. `ground_sigma`: of the session's scale by the height of its
/// cameras; empty if that was not used. A session without a scale of its own has the scale of the
/// landmarks in which it was localised.
///
/// Map frames stay as they are. A keyframe of the session gets the nearest map frame of its piece
/// within 2 m; farther away from all map frames, its own pose becomes one. Poses and landmarks that
/// the adjustment did not move keep their numbers, bit for bit. Landmarks keep their order, new
/// ones follow. Each localised keyframe gives a loop from the nearest keyframe of the map.
[[nodiscard]] Map extended_map(const Map& map,
                               const Session& session,
                               const JoinedSession& joined,
                               const PlacedSession& placed,
                               const Adjusted& adjusted,
                               const MapOptions& options,
                               const std::optional<double>& ground_sigma = std::nullopt);

/// The map without a further session, after poses and tracks of its own were adjusted (those of
/// `joined`, which has no keyframe beyond the map's). What did not move keeps its numbers.
[[nodiscard]] Map adjusted_map(const Map& map,
                               const JoinedSession& joined,
                               const Adjusted& adjusted,
                               const MapOptions& options);

}  // namespace roadbook
