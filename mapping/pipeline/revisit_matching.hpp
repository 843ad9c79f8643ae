#pragma once

#include <vector>

#include "mapping/corner_tracks.hpp"

namespace roadbook {

struct RevisitOptions {
  double radius_m = 2.5;       ///< between two poses that see the same place
  double heading_rad = 0.7;    ///< between their headings
  double min_travel_m = 10.0;  ///< between them, on one piece of a drive
  double search_px = 5.0;      ///< half-size image
  int max_hamming = 90;
  double max_ratio = 0.9;
  int num_threads = 0;
};

/// Corners of one pass found again in another.
///
/// Once the poses are roughly right, each landmark has a place in the other pass's images where it
/// must appear (the search that document 004, section IV-C, uses for localisation). Only keyframes
/// within `piece`s joined by loops are compared. Deterministic on any number of threads.
[[nodiscard]] std::vector<TrackSighting> match_revisits(
    const MappingInput& input,
    const std::vector<Eigen::Isometry3d>& T_map_vehicle,
    const std::vector<int>& piece,
    const RevisitOptions& options);

}  // namespace roadbook
