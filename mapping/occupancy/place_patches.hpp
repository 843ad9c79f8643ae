#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mapping/occupancy/occupancy_patch.hpp"
#include "mapping/occupancy/patch_grid.hpp"

namespace roadbook {

/// The occupancy grid of a map: all patches at the present poses of the map.
struct OccupancyGrid {
  CellShape shape;
  std::vector<float> change;         ///< of the log odds since before any reading, tempered
  std::vector<std::uint32_t> seen;   ///< readings that count; 0: unknown
  std::vector<std::uint32_t> hits;   ///< readings that ended in it
  std::vector<float> effective;      ///< number of independent readings
  std::vector<std::uint8_t> drives;  ///< drives that saw the cell
  std::vector<std::int32_t> newest;  ///< number of the patch seen last, by time; -1: none
  std::size_t moved = 0;             ///< patches placed again
  std::size_t without_pose = 0;      ///< patches whose pose the map no longer has; left out

  /// Probability that the cell is occupied. `prior_log_odds`: before any reading.
  [[nodiscard]] double probability(std::size_t cell, double prior_log_odds) const;
  /// Standard deviation of the probability because readings are few: sqrt(p (1 - p) / (1 + n)).
  /// n: effective readings, at most the change of the log odds over half the change by a ray that
  /// passes the cell. A reading that says next to nothing is none, and contradicting ones are few.
  [[nodiscard]] double sigma(std::size_t cell, double prior_log_odds) const;
};

/// Probabilities from which a cell is called free or occupied: Nav2's thresholds.
inline constexpr double kFreeProbability = 0.196;
inline constexpr double kOccupiedProbability = 0.65;

/// A cell is free if its probability plus two standard deviations is below the threshold: one
/// reading that passed a cell is too little.
[[nodiscard]] inline bool is_free(double probability, double sigma) {
  return probability + 2.0 * sigma < kFreeProbability;
}

/// T_map_vehicle of the keyframe of a session at a stamp; empty if the map does not have it.
using PoseOfKeyframe =
    std::function<std::optional<PlanePose>(const std::string& session, std::int64_t t_ns)>;

/// How the readings of a drive count.
struct ReadingWeight {
  double temper = 1.0;     ///< weight of a further reading of a cell
  bool few_count = false;  ///< a few readings beside unknown ground count: sights of landmarks,
                           ///< which end where a landmark was seen
};

/// Adds up the patches. A patch whose pose moved by more than a quarter of a cell, at any corner,
/// is placed again (`OccupancyPatch::placed`); others stay where they were drawn. Patches must have
/// one cell size. A cell beside unknown ground that one to three rays passed stays unknown.
/// `drives`: by name. Linear in the cells of all patches: 1,000 patches of 200 x 200 cells take
/// less than a second.
[[nodiscard]] OccupancyGrid place_patches(std::vector<OccupancyPatch>& patches,
                                          const PoseOfKeyframe& pose_of,
                                          const std::map<std::string, ReadingWeight>& drives);

}  // namespace roadbook
