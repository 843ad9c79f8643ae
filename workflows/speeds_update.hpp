#pragma once

#include <optional>
#include <vector>

#include "exchange/layers/friction_layers.hpp"
#include "exchange/layers/speed_layers.hpp"
#include "mapping/session_track.hpp"
#include "roadnet/network.hpp"
#include "speedmap/items/layer_item.hpp"
#include "workflows/people/detections.hpp"
#include "workflows/settings/speeds_config.hpp"

namespace roadbook {

/// The inputs of a speed map.
struct SpeedSources {
  RoadNetwork network;
  std::vector<LanePath> paths;
  std::vector<Outline> spaces;
  std::vector<Outline> crossings;
  std::vector<SessionSightings> sightings;
  std::optional<FrictionMap> friction;
  std::vector<LayerItem> items;  ///< all of the map; stale ones have no effect
};

/// Counts how the sightings of a session were used.
struct VisitSummary {
  std::string session;
  std::size_t frames = 0;
  std::size_t people = 0;
  std::size_t off_map = 0;       ///< outside the dynamic map
  std::size_t without_pose = 0;  ///< at times when the map has no pose
  double weight = 1.0;           ///< weight after the decay with age
};

/// Returns the frames of a visit at the times that the sightings give. If the sightings give no
/// times, returns a frame at each detection and at each keyframe without a detection.
[[nodiscard]] std::vector<VisitFrame> visit_frames(const SessionTrack& track,
                                                   const SessionSightings& sightings,
                                                   VisitSummary& summary);

/// An earlier speed map of the place, for a local solution near a few new rows.
struct LocalUpdate {
  const SpeedMap* earlier = nullptr;
  std::size_t solved = 0;  ///< number of solved places; all places if there were too many for a
                           ///< local solution
};

/// Makes the dynamic map, speed map and lane profiles for the time `now_ns`. Throws InvalidOption,
/// and Refused if no lane has a path. With `local`, solves for presence only where it changes, to
/// 1e-6.
[[nodiscard]] SpeedMap make_speed_map(const Map& map,
                                      SpeedSources sources,
                                      const SpeedsConfig& config,
                                      std::int64_t now_ns,
                                      std::vector<VisitSummary>& visits,
                                      LocalUpdate* local = nullptr);

}  // namespace roadbook
