#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/progress.hpp"
#include "mapping/pipeline/parking_row_prior.hpp"
#include "sensors/effects.hpp"

namespace roadbook {

// The effect of rows of equal spaces (mapping/pipeline/parking_row_prior.hpp) on maps of simulated
// drives. The study drives and maps each place, and labels it on the map's own picture with the
// error of a user. Then it adjusts the map again with the rows.

/// One or two drives through a place, and the part of them that is mapped.
struct RowsDrive {
  std::string name;
  std::string scenario;
  std::string size = "full";
  int visits = 1;             ///< sessions
  double seconds = 0.0;       ///< of each visit; 0: complete
  EffectSizes effects{};      ///< that the calibration does not contain
  double image_scale = 0.25;  ///< 320 x 240 pixels for the large places
};

/// The true layout of the spaces, and the accuracy of the labels. Labels come from the truth, so
/// that the study need not paint another place.
struct RowsLabels {
  std::string name;
  double sigma_m = 0.03;  ///< of a label's middle, each coordinate, as stored with it
  double wider = 0.0;     ///< relative excess width of the middle space of each row
  double radius_m = 0.0;  ///< of rows that are curved; 0: straight
  double kink_rad = 0.0;  ///< angle by which rows turn in their middle
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

/// Studies one drive with each kind of labels. The result is deterministic. Throws the exceptions
/// of `simulate` and `build_map`.
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
