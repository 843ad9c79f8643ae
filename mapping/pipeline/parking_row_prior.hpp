#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "base/progress.hpp"
#include "mapping/optimisation/bundle_adjustment.hpp"

namespace roadbook {

// Rows of equal spaces beside the way as a weak prior of bundle adjustment: their middles lie on a
// line at equal steps, and they point one way. Second differences of their places are zero then,
// and so is more: three neighbours alone, with a hand's error of 3 cm, tell nothing of a bend; a
// row of 28 tells its curvature seventy times better, because it is one line that is fitted.
//
// No term of its own: a space is a further pose, tied by motions to the poses that saw it, and a
// row two more: its line, to which the spaces are tied at steps of one free length, and its
// heading. The cost is linear in the number of spaces.

/// Where a pose has a space: a measurement, which nothing but the row joins with others.
struct SpaceView {
  int pose = 0;  ///< index in BundleProblem::poses
  Eigen::Isometry3d T_vehicle_space = Eigen::Isometry3d::Identity();  ///< z up, x one way for a row
  double sigma_m = 0.03;                                              ///< x and y of its middle
  double sigma_rad = 0.012;  ///< of its heading; not above 0: not known
};

struct RowSpace {
  int steps = 0;  ///< from the row's first space; a missing one leaves its number out
  std::vector<SpaceView> views;  ///< at least one
};

struct EqualRow {
  std::vector<RowSpace> spaces;  ///< in order, three or more
};

struct EqualRowOptions {
  double paint_sigma_m = 0.02;  ///< of a space about its place in the row, each coordinate
  double paint_sigma_rad = 0.005;
  double step_sigma = 0.1;  ///< of the length of a step, as share of what the start values say

  /// Throws InvalidOption.
  void check() const;
};

struct EqualRowsUsed {
  std::size_t rows = 0;    ///< that took part
  std::size_t spaces = 0;  ///< in them
  /// The poses would not have these: their squared residuals are beyond what hand and paint
  /// explain (p = 0.01). A row that is crooked or unequal in truth.
  std::size_t refused = 0;
};

/// Adds the poses, motions and scale of each row at the end of `problem`; start values follow from
/// its poses. Throws BadInput for indices out of range.
void add_equal_rows(BundleProblem& problem,
                    const std::vector<EqualRow>& rows,
                    const EqualRowOptions& options = {});

/// `bundle_adjust`, and from its result again with the rows, to a tighter end (1e-7, 100
/// iterations) than `options` may ask for. Rows that do not fit the second result are taken out,
/// and it begins again from the first without them. Leaves what the rows added in `problem`. With
/// no rows that fit: the result without any, to the bit.
BundleResult bundle_adjust_with_rows(BundleProblem& problem,
                                     const std::vector<EqualRow>& rows,
                                     const BundleOptions& options,
                                     const EqualRowOptions& row_options,
                                     EqualRowsUsed& used,
                                     const Progress& progress = {});

}  // namespace roadbook
