#pragma once

#include <string>
#include <vector>

#include "speedmap/experiments/spm_run.hpp"

namespace roadbook {

// The gain of each improvement beyond [SPM], measured alone.

/// The default with one thing taken away (or changed) at a time.
[[nodiscard]] std::vector<SpmMethod> spm_ablation_methods();

/// Labels from a segmentation with a confusion matrix, in a world where every knot has one class.
/// The class frictions are known, so that the study judges only the treatment of the labels.
struct SpmLabelScore {
  std::string method;
  bool blobs = false;       ///< errors shared by 3 x 1 m of ground and 10 m of travel
  double class_nll = 0.0;   ///< -log probability of the true class, mean over the knots
  double class_ece = 0.0;   ///< expected calibration error of the best class, ten bins
  double mean_error = 0.0;  ///< mean |error| of the predicted friction
  /// Two drives with independent errors, z = difference of a share / predicted deviation: 1 and
  /// 0.05 where the counts are honest. 0 for discrete classes, which predict none.
  double z_sd = 0.0;
  double z_outside95 = 0.0;
};
[[nodiscard]] std::vector<SpmLabelScore> spm_label_study(const SpmExperimentOptions& options,
                                                         int maps,
                                                         int num_threads);

/// A wet class that dries, and one that stays: mean |error| of its mean at 40 Hz.
struct SpmForgettingScore {
  double half_life_values = 0.0;  ///< 0: never forgets
  double drying_error = 0.0;      ///< 0.45 to 0.85 with a time constant of 120 s
  double steady_error = 0.0;
};
[[nodiscard]] std::vector<SpmForgettingScore> spm_forgetting_study(std::uint64_t seed);

/// Gross outliers: this share of the friction values is anything in the plausible range.
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
