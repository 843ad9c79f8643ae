#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mapping/store/map_file.hpp"
#include "speedmap/property_map/friction_map.hpp"
#include "speedmap/property_map/lane_strips.hpp"
#include "speedmap/property_map/property_map.hpp"
#include "speedmap/property_map/slice.hpp"

namespace roadbook {

/// Between the names of a friction map's sessions: folders have commas in theirs.
constexpr char kBetweenSessions = '\n';

/// Anchors every knot at the nearest keyframe (within 20 m).
void anchor_knots(const Map& map, FrictionMap& friction);

/// Writes layer `friction` (a point a knot), rasters of every property and tables
/// `friction_settings`, `friction_knots` and `property_classes`, replacing older ones.
void write_friction_layers(MapUpdate& update, const FrictionMap& friction);

/// The friction map over the lanes as they are now; none where `friction` was never run. On the
/// paths it was stored with the numbers are the stored ones. Where the paths are others, every knot
/// goes to where its ground lies now (`KnotAnchor`; without a pose to its share of its lane's
/// length); ground that has become part of a path gets knots that know nothing. What the classes
/// have learned is their prior now. Throws BadInput for tables that do not fit together.
[[nodiscard]] std::optional<FrictionMap> read_friction_layers(const MapLayers& layers,
                                                              const std::vector<LanePath>& lanes);

/// A slice of one lane in the lane's own s; of a ring, around its seam.
[[nodiscard]] PropertySlice lane_slice(const FrictionMap& friction,
                                       const LaneStrips::Strip& strip,
                                       double from_m,
                                       double to_m,
                                       const std::string& map_name,
                                       std::size_t property = 0);

/// Position of a property by name; throws InvalidOption naming `option`.
[[nodiscard]] std::size_t property_of(const PropertyMap& map,
                                      const std::string& name,
                                      const char* option);

/// Where a place of the property map lies [m, map frame], also outside its strip's tube.
[[nodiscard]] Eigen::Vector2d ground_position(const LaneStrips::Strip& strip,
                                              const PathPlace& place);

/// Tables that a build of the map from the drives keeps: what was measured, tied to poses, and what
/// was said.
[[nodiscard]] const std::vector<std::string>& measured_tables();
/// The same of what belongs to all of a map's drives: rounds of learning, by the sessions' numbers.
[[nodiscard]] const std::vector<std::string>& learning_tables();

}  // namespace roadbook
