#include "mapping/pipeline/map_options_text.hpp"

#include <iomanip>
#include <sstream>

#include "mapping/store/map_file_names.hpp"

namespace roadbook {

std::string options_text(const MapOptions& o) {
  std::ostringstream text;
  text << "spacing_m=" << o.tracking.odometry.spacing_m
       << " turn_rad=" << o.tracking.odometry.turn_rad
       << " max_features=" << o.tracking.features.max_features
       << " threshold=" << o.tracking.features.threshold
       << " low_threshold=" << o.tracking.features.low_threshold
       << " use_wheels=" << o.tracking.use_wheels << " max_gap_s=" << o.tracking.max_gap_s
       << " min_inliers=" << o.loops.min_inliers << " per_image=" << o.bundle.per_image
       << " reach_keyframes=" << o.bundle.reach_keyframes
       << " reach_of_many_passes=" << o.bundle.reach_of_many_passes
       << " wheel_scale_sigma=" << o.bundle.wheel_scale_sigma
       << " ground_sigma_m=" << o.bundle.ground_sigma_m << " min_views=" << o.min_views
       << " covariances=" << o.covariances;
  if (o.vehicle) {
    text << " vehicle=";
    for (const auto& value : vehicle_values(*o.vehicle))
      text << std::setprecision(17) << value.value_or(-1.0) << ',';
    text << std::setprecision(6);
  }
  if (o.bundle.bundle.solver == LeastSquaresSolver::kCeres) text << " solver=ceres";
  if (o.equal_rows) text << " equal_rows=1";
  for (const auto& [name, size] : o.model)
    text << ' ' << name << '=' << std::setprecision(17) << size;
  return text.str();
}

}  // namespace roadbook
