#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "base/progress.hpp"
#include "mapping/optimisation/bundle_adjustment.hpp"

namespace roadbook {

// Rows of equal spaces along the way as a weak prior of bundle adjustment: their centres lie on a
// line at equal steps, and their headings are equal. One line is fitted to a whole row. Second
// differences of three neighbours, with a hand error of 3 cm, do not constrain a bend; a row of 28
// spaces constrains its curvature seventy times better.
// There is no new residual type. A space is a further pose, tied by motions to the poses that saw
// it. A row adds two poses: its line, to which the spaces are tied at steps of one free length, and
// its heading. The cost is linear in the number of spaces.

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
  double step_sigma = 0.1;  ///< of the length of a step, as a share of the start value

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

/// Runs `bundle_adjust`, then again from its result with the rows, to a tighter end (1e-7, 100
/// iterations) than `options` may ask for. Rows that do not fit the second result are removed, and
/// the second run starts again without them. Leaves the rows' contributions in `problem`. If no row
/// fits, the result is bit for bit that of the first run.
BundleResult bundle_adjust_with_rows(BundleProblem& problem,
                                     const std::vector<EqualRow>& rows,
                                     const BundleOptions& options,
                                     const EqualRowOptions& row_options,
                                     EqualRowsUsed& used,
                                     const Progress& progress = {});

}  // namespace roadbook
