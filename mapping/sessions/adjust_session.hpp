#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mapping/cameras/camera_doubts.hpp"
#include "mapping/pipeline/map_stages.hpp"
#include "mapping/sessions/join_session.hpp"

namespace roadbook {

/// Adjusts a map with a further session [metric-semantic maps, section IV-B, over sessions].
///
/// - SessionAdjust::kNear: free are the session's poses and half as many poses of the map, which
///   see most of its landmarks. The other poses are fixed; of each point they take part with a few
///   views. So the cost does not grow with the number of sessions.
/// - SessionAdjust::kAll: all poses; the first session's poses have a weak prior as the gauge.
/// - SessionAdjust::kNone: the session's poses, against landmarks of the map that do not move.
///
/// Tracks of the session whose views contradict each other are split. The result's `tracks` have
/// positions, its covariances are empty. Deterministic on any number of threads. Throws Refused if
/// the adjustment fails; Interrupted.
[[nodiscard]] Adjusted adjust_session(const JoinedSession& joined,
                                      const Map& map,
                                      const MapOptions& options,
                                      const Progress& progress);

/// Adds covariances, if `options` want them. After SessionAdjust::kAll of everything: `doubts`
/// about the last session's cameras widen them (common_camera_errors.hpp). Otherwise of the
/// landmarks that the session sees or has moved, given the poses: no doubt widens those.
void add_covariances_of_session(const JoinedSession& joined,
                                std::vector<CameraDoubt> doubts,
                                const MapOptions& options,
                                Adjusted& adjusted);

/// What holds the map where it is, in words for `map_meta`.
[[nodiscard]] std::string gauge_of(SessionAdjust adjust);

/// The part of an adjustment that belongs to the session: its poses and observations, with indices
/// as if it were alone.
[[nodiscard]] Adjusted session_alone(const JoinedSession& joined, const Adjusted& adjusted);

}  // namespace roadbook
