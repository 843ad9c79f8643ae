#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/progress.hpp"
#include "mapping/pipeline/parking_row_prior.hpp"
#include "sensors/effects.hpp"

namespace roadbook {

// What rows of equal spaces (mapping/pipeline/parking_row_prior.hpp) do to maps of simulated
// drives: each place is driven, mapped, labelled with a hand's error on the map's own picture, and
// adjusted again with the rows.

/// One or two drives through a place, and the part of them that is mapped.
struct RowsDrive {
  std::string name;
  std::string scenario;
  std::string size = "full";
  int visits = 1;             ///< sessions
  double seconds = 0.0;       ///< of each; 0: whole
  EffectSizes effects{};      ///< that the calibration does not tell
  double image_scale = 0.25;  ///< 320 x 240 pixels of the large places
};

/// How the spaces of a place lie in truth and how well they are drawn. Labels are taken from the
/// truth, so that no other place need be painted.
struct RowsLabels {
  std::string name;
  double sigma_m = 0.03;  ///< of a label's middle, each coordinate, as stored with it
  double wider = 0.0;     ///< share by which the middle space of each row is wider
  double radius_m = 0.0;  ///< of rows that are curved; 0: straight
  double kink_rad = 0.0;  ///< by which rows turn in their middle
  double uneven_m = 0.0;  ///< of each space along its row, standard deviation
};

struct RowsErrors {
  double ate_rmse_m = 0.0;    ///< of keyframes against the truth, rigidly aligned
  double label_rmse_m = 0.0;  ///< of labels' middles from above, same alignment
};

struct RowsOutcome {
  std::string labels;  ///< RowsLabels::name
  RowsErrors off;
  RowsErrors on;
  std::size_t labelled = 0;  ///< spaces
  EqualRowsUsed used;
};

/// One drive, each kind of labels in turn. Deterministic. Throws as `simulate` and `build_map`.
[[nodiscard]] std::vector<RowsOutcome> study_rows(const RowsDrive& drive,
                                                  const std::vector<RowsLabels>& labels,
                                                  std::uint64_t seed,
                                                  int num_threads,
                                                  const Progress& progress = {});

/// Geometric mean of ratios with its 95 % interval (Student's t of their logarithms).
struct RatioInterval {
  double ratio = 1.0;
  double low = 1.0;
  double high = 1.0;
};
[[nodiscard]] RatioInterval ratio_interval(const std::vector<double>& ratios);

}  // namespace roadbook
