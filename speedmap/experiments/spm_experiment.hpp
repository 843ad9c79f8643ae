#pragma once

#include <string>
#include <vector>

#include "base/progress.hpp"
#include "speedmap/experiments/spm_run.hpp"

namespace roadbook {

// The experiments of [SPM, section 4]: Fig. 2 (KL against distance) and Fig. 3 (errors along
// horizons) over all maps and methods.

/// Errors along one kind of horizon by one method; horizons of one map follow each other.
struct SpmHorizonScore {
  std::string method;
  SpmErrors errors;
};

struct SpmMethodScore {
  std::string method;
  std::vector<double> distance_m;
  std::vector<std::vector<double>> kl;           ///< map x distance
  std::vector<double> kl_all_start, kl_all_end;  ///< per map, over the whole road
  int locked = 0;
  int improved = 0;  ///< maps whose KL fell
  int rejected = 0;
};

struct SpmExperiment {
  std::vector<SpmMethodScore> methods;
  std::vector<SpmHorizonScore> horizons;  ///< the paper's probe line
  std::vector<SpmHorizonScore> drivable;  ///< one that a car can follow
  int horizons_per_map = 0;
  double pixels_per_frame = 0.0;
};

/// Runs the experiment, maps in parallel. The result is the same for any number of threads.
/// `baselines`: also runs Kalman filter (KF) and Gaussian process (GP), which take most of the
/// time.
[[nodiscard]] SpmExperiment run_spm_experiment(const SpmExperimentOptions& options,
                                               const std::vector<SpmMethod>& methods,
                                               bool baselines,
                                               int num_threads,
                                               const Progress& progress = {});

/// Returns the number of maps in which the median RMS error of `method` is below half of that of
/// every baseline (KF, GP).
[[nodiscard]] int maps_below_half(const std::vector<SpmHorizonScore>& horizons,
                                  std::size_t method,
                                  std::size_t first_baseline,
                                  int horizons_per_map);

/// Standard deviations of the random walk per measurement that the Kalman filter is run with.
[[nodiscard]] const std::vector<double>& spm_kalman_walks();

/// Mean and half width of its 95 % interval (Student t).
struct MeanInterval {
  double mean = 0.0;
  double half = 0.0;
};
[[nodiscard]] MeanInterval mean_interval95(const std::vector<double>& values);
/// Quantile by linear interpolation between the sorted values.
[[nodiscard]] double quantile(std::vector<double> values, double q);

}  // namespace roadbook
