#pragma once

#include <vector>

#include "roadnet/paths/path_frame.hpp"
#include "speedmap/experiments/spm_experiment_options.hpp"
#include "speedmap/property_map/property_map.hpp"

namespace roadbook {

// The truth of the experiment: a road and ten maps of it.

/// Makes two miles of road as a path, from its heading.
[[nodiscard]] PathFrame spm_road(const SpmExperimentOptions& options);

/// A grid of knots over the experiment's road.
[[nodiscard]] Knots spm_knots(const SpmExperimentOptions& options,
                              double spacing_m,
                              double kernel_width_m);

/// One true map: each knot has a class, and each class a friction.
struct SpmTruth {
  PropertyMap map;  ///< p(Theta; P^t)
  std::vector<int> knot_class;
};
[[nodiscard]] SpmTruth spm_truth(const SpmExperimentOptions& options, std::uint64_t index);

/// Prior of the estimator: the true parameters, each multiplied by 1 + U(-0.9, 0.9), as in the
/// paper. `PropertyMapOptions::prior_mean_sigma` gives it an uncertainty that fits these errors.
[[nodiscard]] PropertyMapPrior spm_prior(const SpmExperimentOptions& options,
                                         const SpmTruth& truth,
                                         std::uint64_t index);

/// The vehicle's records along the first `until_m` metres.
struct SpmFrame {
  double distance_m = 0.0;
  std::vector<PathPlace> places;  ///< of the pixels
  std::vector<int> labels;
};
struct SpmValue {
  double distance_m = 0.0;
  PathPlace place;
  double friction = 0.0;
};
struct SpmRecord {
  std::vector<SpmFrame> frames;
  std::vector<SpmValue> values;
};
[[nodiscard]] SpmRecord spm_record(const SpmExperimentOptions& options,
                                   const PathFrame& road,
                                   const SpmTruth& truth,
                                   std::uint64_t index,
                                   double until_m);

/// Ground points [m, vehicle frame] of the experiment's thinned pixels, through the camera model.
[[nodiscard]] std::vector<Eigen::Vector2d> spm_pixels(const SpmExperimentOptions& options);

/// Lateral position e [m] of the vehicle at distance `s_m` along the road.
[[nodiscard]] double spm_weave(const SpmExperimentOptions& options, double s_m);

}  // namespace roadbook
