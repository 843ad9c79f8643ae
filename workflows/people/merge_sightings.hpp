#pragma once

#include <vector>

#include "workflows/people/detections.hpp"

namespace roadbook {

/// What became of rows when new sightings met those that the map has.
struct MergeCount {
  std::size_t added = 0;     ///< new rows
  std::size_t known = 0;     ///< rows that were there already
  std::size_t replaced = 0;  ///< older rows that gave way
};

/// Adds sightings to what is known of their sessions, in the map's order: rows beside rows, each
/// once, so that a table given twice counts once. With `replace` a session's older rows give way to
/// its new ones. What hid people from view stays where the new sightings do not tell it.
MergeCount merge_sightings(std::vector<SessionSightings>& into,
                           std::vector<SessionSightings> added,
                           const Map& map,
                           bool replace);

}  // namespace roadbook
