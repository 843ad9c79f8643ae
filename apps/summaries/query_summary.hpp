#pragma once

#include <vector>

#include "apps/console.hpp"
#include "exchange/export/planner/lane_queries.hpp"

namespace roadbook {

/// A place on a lane: path coordinates [m], e positive to the left.
struct LanePlace {
  const LaneStrips::Strip* strip;
  double s_m;
  double e_m;
};

/// Prints speed, presence, friction and ground at each place; with `--json` as one object. Throws
/// InvalidOption for a place outside its lane.
void print_answers(const Console& console,
                   const LaneQueries& known,
                   const std::vector<LanePlace>& places);

}  // namespace roadbook
