#pragma once

#include <string>
#include <vector>

#include "exchange/export/planner/planner_map.hpp"

namespace roadbook {

// The roads of an OpenDRIVE file. A road has one lane and is driven from its begin to its end: a
// lane driven both ways is a pair of roads, a turn driven both ways two connecting roads.

/// The road or junction at the begin or end of a road.
struct DriveRoadEnd {
  int road = -1;      ///< number in `DriveRoads::roads`; -1: none
  int junction = -1;  ///< number of a junction; -1: none
};

struct DriveRoad {
  PathCurve curve;       ///< in driving direction
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
  std::size_t narrowed = 0;  ///< lanes with a bend too tight for their whole width
  std::size_t widened = 0;   ///< lanes narrower than SUMO requires for cars
};

/// Makes the roads of a map. Rings are cut in three and lanes that return to their intersection in
/// two, because SUMO names the node between two roads after them and allows no edge from a node to
/// itself.
///
/// SUMO gives a turn the mean of the limits before and after it. Therefore the limits next to a
/// turn, over at least 5 m, are not above the limits of the turns that begin or end there.
[[nodiscard]] DriveRoads drive_roads(const PlannerMap& planner);

/// "lane 17", "lane 17 back", "lane 17 part 2 of 3", "turn 4".
[[nodiscard]] std::string name_of(const PlannerMap& planner, const DriveRoad& road);

}  // namespace roadbook
