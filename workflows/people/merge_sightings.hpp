#pragma once

#include <vector>

#include "workflows/people/detections.hpp"

namespace roadbook {

/// The result of merging new sightings with those of the map.
struct MergeCount {
  std::size_t added = 0;     ///< new rows
  std::size_t known = 0;     ///< rows that the map already had
  std::size_t replaced = 0;  ///< older rows that were replaced
};

/// Adds sightings to the known sightings of their sessions, in the map's order. Each row occurs
/// once in the result, so that a table given twice counts once. With `replace`, the new rows of a
/// session replace its older rows. The known sight blockers stay, unless the new sightings give
/// others.
MergeCount merge_sightings(std::vector<SessionSightings>& into,
                           std::vector<SessionSightings> added,
                           const Map& map,
                           bool replace);

}  // namespace roadbook
