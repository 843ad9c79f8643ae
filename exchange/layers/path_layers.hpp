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

/// The paths as they were written, control points bit for bit. Throws BadInput where the map has no
/// paths, or where they do not fit together.
[[nodiscard]] std::vector<LanePath> read_path_layers(const MapLayers& layers);

/// Digest of the curves: what lies along them (friction, speeds) belongs to these paths alone.
[[nodiscard]] std::string paths_digest(const std::vector<LanePath>& paths);

/// The four corners of a parking space, turned so that the two of the open side come first: of the
/// short sides the one nearer to a lane.
[[nodiscard]] std::vector<Eigen::Vector3d> corners_with_open_side_first(
    std::vector<Eigen::Vector3d> corners, const RoadNetwork& network);

/// Spaces of a polygon layer of rectangles; messages name `map` where the layer is of another kind.
/// The open side is the short side nearer to a lane. Ids come from a numeric column `space` where
/// it exists, otherwise they count from 0.
[[nodiscard]] std::vector<SpacePlace> read_spaces(const std::filesystem::path& map,
                                                  const VectorLayer& polygons,
                                                  const RoadNetwork& network);

/// Writes table `space_links`: space, lane (id as text), s_m, distance_m, left, status, reason.
void write_link_table(MapUpdate& update, const std::vector<LaneLink>& links);

}  // namespace roadbook
