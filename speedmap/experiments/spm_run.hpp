#pragma once

#include <string>
#include <vector>

#include "speedmap/experiments/spm_world.hpp"
#include "speedmap/property_map/property_mapper.hpp"

namespace roadbook {

/// One way to estimate the map, as compared by the experiment.
struct SpmMethod {
  std::string name;
  PropertyMapOptions map;
  RefreshOptions refresh;
  double label_weight = 1.0;
  double knot_spacing_m = 0.0;  ///< of the estimate; 0: as in the truth
  double kernel_width_m = 0.0;  ///< of the estimate; 0: as in the truth
};

/// The methods that the experiment compares: printed formulas and prior, then one correction after
/// the other, and last the default.
[[nodiscard]] std::vector<SpmMethod> spm_methods();
/// The default with other kernel widths and knot spacings.
[[nodiscard]] std::vector<SpmMethod> spm_sensitivity_methods(const SpmExperimentOptions& options);

/// A line of positions ahead of the vehicle: e = amplitude cos(2 pi n / wavelength) after n metres,
/// with the paper's sign of e.
struct SpmHorizonShape {
  double amplitude_m = 3.5;
  double wavelength_m = 20.0;
  int points = 80;
};
/// The paper's probe line, which no car could follow (radius 2.9 m), and a drivable one.
[[nodiscard]] SpmHorizonShape probe_horizon(const SpmExperimentOptions& options);
[[nodiscard]] SpmHorizonShape drivable_horizon(const SpmExperimentOptions& options);

/// Errors of the predicted mean along horizons, a number per horizon.
struct SpmErrors {
  std::vector<double> mean_abs;
  std::vector<double> rms;
  std::vector<double> nll;  ///< expected -log density of a measurement, given the truth's moments

  void add(const std::vector<PropertyMoments>& truth, const std::vector<PropertyMoments>& got);
};

/// One method on one map.
struct SpmMapRun {
  std::vector<double> distance_m;  ///< where scored
  std::vector<double> kl;          ///< mean over the knots of the first `score_until_m`
  double kl_all_start = 0.0;       ///< over all knots of the two miles
  double kl_all_end = 0.0;
  double worst_class_error = 0.0;  ///< largest error of a class mean at the end
  bool locked = false;             ///< it is above 0.1
  int rejected = 0;                ///< updates rejected because a projection was not proper
  int refreshes = 0;
  SpmErrors probe, drivable;
};

/// KL(N(truth) || N(estimate)) of one knot's likelihood moments.
[[nodiscard]] double normal_kl(const PropertyMoments& truth, const PropertyMoments& estimate);

[[nodiscard]] SpmMapRun run_spm(const SpmExperimentOptions& options,
                                const SpmTruth& truth,
                                const SpmRecord& record,
                                const SpmMethod& method,
                                std::uint64_t index);

/// Updates a map with the first `until_m` metres of a record.
void play(const SpmRecord& record, const SpmMethod& method, double until_m, PropertyMapper& mapper);

/// The horizon's places from `s0_m` on.
[[nodiscard]] std::vector<PathPlace> spm_horizon(const SpmHorizonShape& shape, double s0_m);
/// The map's moments at `places`; the road must be long enough.
[[nodiscard]] std::vector<PropertyMoments> moments_along(const PropertyMap& map,
                                                         const std::vector<PathPlace>& places);
/// Where horizons begin.
[[nodiscard]] std::vector<double> spm_horizon_starts(const SpmExperimentOptions& options);

}  // namespace roadbook
