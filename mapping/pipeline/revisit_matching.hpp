#pragma once

#include <vector>

#include "mapping/joined_tracks.hpp"
#include "mapping/pipeline/pass_numbers.hpp"

namespace roadbook {

struct RevisitOptions {
  PlacePassOptions passes;  ///< when two poses see the same place
  double search_px = 5.0;   ///< around the predicted pixel, half-size image
  int max_hamming = 90;     ///< of 512 bits
  double max_ratio = 0.9;   ///< nearest over second-nearest descriptor distance
  int num_threads = 0;
};

/// Projects the tracks of one keyframe, whose positions [m, map] are known, into the images of the
/// same cameras at another one, and searches the features near those pixels.
[[nodiscard]] std::vector<TrackMatch> match_tracks_of(
    const MappingInput& input,
    const std::vector<Eigen::Isometry3d>& T_map_vehicle,
    const std::vector<std::optional<Eigen::Vector3d>>& places,
    std::size_t from_keyframe,
    std::size_t to_keyframe,
    const RevisitOptions& options);

/// Finds the tracks of one pass again in the images of another pass.
///
/// With approximate poses each triangulated track is projected into the nearest earlier pass and
/// searched for near that pixel, as localisation does [metric-semantic maps, section IV-C].
/// `component` of each keyframe (PoseGraphResult): only keyframes of one component are compared.
/// Deterministic on any number of threads.
[[nodiscard]] std::vector<TrackMatch> match_revisits(
    const MappingInput& input,
    const std::vector<Eigen::Isometry3d>& T_map_vehicle,
    const std::vector<int>& component,
    const RevisitOptions& options);

}  // namespace roadbook
