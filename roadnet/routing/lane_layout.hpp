#pragma once

#include <vector>

#include "roadnet/network.hpp"
#include "roadnet/paths/lane_path.hpp"
#include "roadnet/paths/path_curve.hpp"
#include "roadnet/routing/routing.hpp"

namespace roadbook {

// A road network in the form of planners' formats: lanes that end before the intersections, and
// curves across the intersections that join them without a kink.

struct LaneLayoutOptions {
  double cut_m =
      6.0;  ///< lanes end this far before an intersection, short ones less: room for a turn
  RoutingOptions routing;  ///< which turns there are
};

/// A lane between its cuts, in the direction of traffic. If a lane was only driven against its
/// direction, its curve is reversed.
struct LanePiece {
  int lane = -1;  ///< index in the network
  std::uint64_t id = 0;
  PathCurve curve;         ///< of the whole lane
  bool turned = false;     ///< the curve runs last to first point of the lane
  double s_begin_m = 0.0;  ///< on the curve
  double s_end_m = 0.0;
  bool both_ways = false;
  double width_m = 0.0;
  [[nodiscard]] double length_m() const { return s_end_m - s_begin_m; }
};

/// An end of a piece.
struct PieceEnd {
  int piece = -1;
  bool at_end = true;  ///< where the piece's curve ends, not where it begins
};

/// A curve over an intersection, in driving direction: from one piece's end to another's.
struct Connector {
  int intersection = -1;
  PieceEnd from;
  PieceEnd to;
  bool both_ways = false;
  PathCurve curve;
  double width_m = 0.0;  ///< the smaller of the two lanes'
};

struct LaneLayout {
  std::vector<LanePiece> pieces;      ///< in the order of the lanes; degenerate ones are left out
  std::vector<Connector> connectors;  ///< by intersection, then by pieces
};

/// Cuts the lanes and connects them. Position, tangent and curvature agree where pieces and
/// connectors meet. `paths`: those of `network`, in any order; a lane without a path is left out.
[[nodiscard]] LaneLayout lay_out(const RoadNetwork& network,
                                 const std::vector<LanePath>& paths,
                                 const LaneLayoutOptions& options = {});

/// A curve of degree 5 between two points with their directions and curvatures.
[[nodiscard]] PathCurve connecting_curve(const PathPoint& from, const PathPoint& to);

}  // namespace roadbook
