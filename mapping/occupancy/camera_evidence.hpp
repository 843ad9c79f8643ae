#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mapping/occupancy/build_patches.hpp"

namespace roadbook {

// Free space from cameras alone. Where the line of sight to a landmark on the ground is lower than
// the lowest obstacle, the cells are free. The cell of a raised landmark is occupied; its line of
// sight passes above the ground and gives no evidence. Each cell counts sights of both kinds. The
// counts of all cells determine how much a sight changes a cell.

/// The images of one keyframe.
struct SightKeyframe {
  std::int64_t t_ns = 0;
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< of the vehicle, map frame [m]
  std::size_t anchor = 0;                            ///< index of its keyframe in the anchors
};

/// A landmark in one view. Ascending in `landmark`, then in `view`.
struct CameraSight {
  int landmark = 0;
  std::size_t view = 0;
  bool raised = false;
  Eigen::Vector2d p = Eigen::Vector2d::Zero();    ///< of the landmark, map frame [m]
  Eigen::Vector2d low = Eigen::Vector2d::Zero();  ///< on the ground: where the line of sight is
                                                  ///< as high as the lowest obstacle
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of `p`, of a raised landmark
};

/// Sights in one cell. A raised landmark counts in each cell with the probability that it lies
/// there.
struct CellSights {
  double raised = 0.0;
  double low = 0.0;  ///< lines of sight to the ground
};

/// How often a sight of a cell is one of a raised landmark.
struct SightRates {
  double raised_if_occupied = 0.0;
  double raised_if_free = 0.0;
  double occupied = 0.0;    ///< share of occupied cells among those with sights
  double dispersion = 1.0;  ///< variance of the counts over that of independent sights, at least 1
  double sights_a_cell = 1.0;

  /// Change of a cell's log odds by one sight.
  [[nodiscard]] double change(bool raised) const;
  /// Whether one raised landmark in a cell makes it more likely occupied than free.
  [[nodiscard]] bool shows_obstacles() const;
  /// Weight of each sight after the first, from the dispersion.
  [[nodiscard]] double temper() const;
};

/// Fits the rates to the counts of all cells: a mixture of two binomial distributions, by
/// expectation maximisation (Dempster, Laird and Rubin 1977). Each rate has one sight of either
/// kind as its prior. Empty if the cells do not show two kinds: no raised or no low sights.
[[nodiscard]] std::optional<SightRates> fit_sight_rates(std::span<const CellSights> cells);

struct CameraPatches {
  SightRates rates;
  BuiltPatches built;
};

/// The sights of a drive as patches. A landmark counts once in a cell, however many images show it.
/// Empty if `fit_sight_rates` is. `options.update` and `cone_rad` are not used. The result does not
/// depend on the number of threads. Throws InvalidOption.
[[nodiscard]] std::optional<CameraPatches> build_camera_patches(
    std::span<const SightKeyframe> views,
    std::span<const CameraSight> sights,
    const std::vector<PatchAnchor>& anchors,
    const std::string& drive,
    const BuildPatchesOptions& options);

}  // namespace roadbook
