#pragma once

#include <string>
#include <vector>

#include "speedmap/property_mapper.hpp"
#include "speedmap/spm_world.hpp"

namespace roadbook {

/// One way to estimate the map, as compared by the experiment.
struct SpmMethod {
  std::string name;
  bool calibrated_prior = true;
  PropertyMapOptions map;
  RefreshOptions refresh;
  double label_weight = 1.0;
};

/// The comparison of the experiment: literal formulas and prior, the reference's steps, the
/// default.
[[nodiscard]] std::vector<SpmMethod> spm_methods(const SpmExperimentOptions& options);

/// One method on one map.
struct SpmMapRun {
  std::vector<double> distance_m;  ///< where scored
  std::vector<double> kl;          ///< mean over the knots of the first `score_until_m`
  double kl_all_start = 0.0;       ///< over all knots of the two miles
  double kl_all_end = 0.0;
  bool locked = false;  ///< a class mean ended wrong by more than 0.1
  int rejected = 0;     ///< updates that a projection would have left its family by
  int refreshes = 0;
  std::vector<double> horizon_error;  ///< mean |error| along each horizon
  std::vector<double>
      horizon_nll;  ///< mean -log density of the true mean's neighbourhood, see .cpp
};

/// KL(N(truth) || N(estimate)) of one knot's likelihood moments.
[[nodiscard]] double normal_kl(const PropertyMoments& truth, const PropertyMoments& estimate);

[[nodiscard]] SpmMapRun run_spm(const SpmExperimentOptions& options,
                                const SpmTruth& truth,
                                const SpmRecord& record,
                                const SpmMethod& method,
                                std::uint64_t index);

/// The horizon's places at `s0_m`.
[[nodiscard]] std::vector<PathPlace> spm_horizon(const SpmExperimentOptions& options, double s0_m);
/// Where horizons begin.
[[nodiscard]] std::vector<double> spm_horizon_starts(const SpmExperimentOptions& options);

}  // namespace roadbook
