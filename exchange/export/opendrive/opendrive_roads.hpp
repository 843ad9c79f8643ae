#pragma once

#include <string>
#include <vector>

#include "exchange/export/planner/planner_map.hpp"

namespace roadbook {

// The roads of an OpenDRIVE file. A road has one lane and is driven from its begin to its end: a
// lane driven both ways is a pair of roads, a turn driven both ways two connecting roads.

/// What a road's begin or end leads to.
struct DriveRoadEnd {
  int road = -1;      ///< number in `DriveRoads::roads`; -1: none
  int junction = -1;  ///< number of a junction; -1: none
};

struct DriveRoad {
  PathCurve curve;       ///< runs the way the road is driven
  double begin_m = 0.0;  ///< on the curve
  double end_m = 0.0;
  double width_m = 0.0;
  DriveRoadEnd before{};
  DriveRoadEnd after{};
  std::vector<SpeedPiece> speeds{};  ///< on the curve
  int piece = -1;                    ///< lane piece that it is a part of; -1: a turn
  bool backward = false;             ///< against the curve of the piece
  int part = 0;                      ///< of a piece cut in parts, from 0 in driving direction
  int parts = 1;
  int connector = -1;  ///< turn; its junction is `junction`
  int junction = -1;

  [[nodiscard]] double length_m() const { return end_m - begin_m; }
};

struct DriveJunction {
  int intersection = -1;   ///< index in the network
  std::vector<int> turns;  ///< numbers of its connecting roads
};

struct DriveRoads {
  std::vector<DriveRoad> roads;  ///< lanes in the order of the pieces, then turns
  std::vector<DriveJunction> junctions;
  std::size_t narrowed = 0;  ///< lanes bent so much that their whole width has no place
  std::size_t widened = 0;   ///< lanes narrower than SUMO lets cars on
};

/// Roads of a map. Rings are cut in three and lanes that return to their intersection in two: SUMO
/// names the node between two roads after them, and takes no edge from a node to itself.
///
/// SUMO gives a turn the mean of the limits before and after it. So the limits next to a turn, over
/// 5 m at least, are not above those of the turns that begin or end there.
[[nodiscard]] DriveRoads drive_roads(const PlannerMap& planner);

/// "lane 17", "lane 17 back", "lane 17 part 2 of 3", "turn 4".
[[nodiscard]] std::string name_of(const PlannerMap& planner, const DriveRoad& road);

}  // namespace roadbook
