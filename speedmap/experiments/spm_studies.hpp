#pragma once

#include <string>
#include <vector>

#include "speedmap/experiments/spm_run.hpp"

namespace roadbook {

// Studies that measure the gain of each improvement beyond [SPM] alone.

/// The default with one part removed (or changed) at a time.
[[nodiscard]] std::vector<SpmMethod> spm_ablation_methods();

/// Labels from a segmentation with a confusion matrix, in a world where every knot has one class.
/// The class frictions are known, so that the study judges only the treatment of the labels.
struct SpmLabelScore {
  std::string method;
  bool blobs = false;       ///< errors shared by 3 x 1 m of ground and 10 m of travel
  double class_nll = 0.0;   ///< -log probability of the true class, mean over the knots
  double class_ece = 0.0;   ///< expected calibration error of the best class, ten bins
  double mean_error = 0.0;  ///< mean |error| of the predicted friction
  /// For two drives with independent errors, z = difference of a class share over its predicted
  /// standard deviation. Calibrated counts give a standard deviation of 1, and 0.05 outside the 95
  /// % interval. 0 for discrete classes, which predict no deviation.
  double z_sd = 0.0;
  double z_outside95 = 0.0;
};
[[nodiscard]] std::vector<SpmLabelScore> spm_label_study(const SpmExperimentOptions& options,
                                                         int maps,
                                                         int num_threads);

/// Mean |error| of a class mean at 40 Hz, for a wet class that dries and for one that stays wet.
struct SpmForgettingScore {
  double half_life_values = 0.0;  ///< 0: never forgets
  double drying_error = 0.0;      ///< 0.45 to 0.85 with a time constant of 120 s
  double steady_error = 0.0;
};
[[nodiscard]] std::vector<SpmForgettingScore> spm_forgetting_study(std::uint64_t seed);

/// Result with gross outliers: `share` of the friction values are uniform in the plausible range.
struct SpmOutlierScore {
  double outlier_weight = 0.0;
  double share = 0.0;
  double kl = 0.0;          ///< at the end, mean over the maps
  double mean_error = 0.0;  ///< largest error of a class mean, mean over the maps
};
[[nodiscard]] std::vector<SpmOutlierScore> spm_outlier_study(const SpmExperimentOptions& options,
                                                             int maps,
                                                             int num_threads);

}  // namespace roadbook
