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

/// Separator of session names in a friction map. Names of folders may contain commas.
constexpr char kBetweenSessions = '\n';

/// Anchors every knot at the nearest keyframe (within 20 m).
void anchor_knots(const Map& map, FrictionMap& friction);

/// Writes layer `friction` (a point a knot), rasters of every property and tables
/// `friction_settings`, `friction_knots` and `property_classes`, replacing older ones.
void write_friction_layers(MapUpdate& update, const FrictionMap& friction);

/// Reads the friction map over the current lanes; empty if `friction` was never run. If the paths
/// are those it was stored with, the numbers are the stored ones. Otherwise every knot moves to the
/// current position of its ground (`KnotAnchor`; without a pose, to its share of its lane's
/// length). Ground that is new on a path gets knots with the prior only. The classes keep their
/// beliefs as prior. Throws BadInput for tables that contradict each other.
[[nodiscard]] std::optional<FrictionMap> read_friction_layers(const MapLayers& layers,
                                                              const std::vector<LanePath>& lanes);

/// Cuts a slice of one lane, with s along this lane; on a ring it may cross the start.
[[nodiscard]] PropertySlice lane_slice(const FrictionMap& friction,
                                       const LaneStrips::Strip& strip,
                                       double from_m,
                                       double to_m,
                                       const std::string& map_name,
                                       std::size_t property = 0);

/// Returns the index of the property with this name. Throws InvalidOption, which names `option`,
/// for an unknown property.
[[nodiscard]] std::size_t property_of(const PropertyMap& map,
                                      const std::string& name,
                                      const char* option);

/// Converts a position of the property map to the map frame [m], also outside the tube of its
/// strip.
[[nodiscard]] Eigen::Vector2d ground_position(const LaneStrips::Strip& strip,
                                              const PathPlace& place);

/// Tables that a new build of the map keeps: measurements relative to poses, examples, and the
/// configuration of speeds.
[[nodiscard]] const std::vector<std::string>& measured_tables();
/// Tables that a new build keeps only if it begins with all drives of the map, because they refer
/// to sessions by number: training rounds and further anchors.
[[nodiscard]] const std::vector<std::string>& learning_tables();

}  // namespace roadbook
