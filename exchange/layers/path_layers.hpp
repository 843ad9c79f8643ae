#pragma once

#include <vector>

#include "exchange/layers/network_layers.hpp"
#include "roadnet/paths/lane_path.hpp"
#include "roadnet/routing/lane_link.hpp"

namespace roadbook {

/// Writes layer `lane_paths` (the paths as lines, for GIS programs) and table `lane_path_segments`
/// (their control points), replacing older ones. Degenerate lanes are in neither.
void write_path_layers(MapUpdate& update,
                       const std::vector<LanePath>& paths,
                       const RoadNetwork& network,
                       const NetworkSource& source);

/// Reads the paths, with the same bits of control points as written. Throws BadInput if the map has
/// no paths, or its tables contradict each other.
[[nodiscard]] std::vector<LanePath> read_path_layers(const MapLayers& layers);

/// Digest of the curves. Friction and speeds store it, because they are valid for these paths only.
[[nodiscard]] std::string paths_digest(const std::vector<LanePath>& paths);

/// Returns the four corners of a parking space in an order that starts with the two of the open
/// side: the short side nearer to a lane.
[[nodiscard]] std::vector<Eigen::Vector3d> corners_with_open_side_first(
    std::vector<Eigen::Vector3d> corners, const RoadNetwork& network);

/// Reads spaces from a polygon layer of rectangles. The open side is the short side nearer to a
/// lane. Ids come from a numeric column `space` if it exists, otherwise they count from 0. Throws
/// BadInput about file `map` for another kind of layer.
[[nodiscard]] std::vector<SpacePlace> read_spaces(const std::filesystem::path& map,
                                                  const VectorLayer& polygons,
                                                  const RoadNetwork& network);

/// Writes table `space_links`: space, lane (id as text), s_m, distance_m, left, status, reason.
void write_link_table(MapUpdate& update, const std::vector<LaneLink>& links);

}  // namespace roadbook
