#include "mapping/travelled.hpp"

namespace roadbook {

std::vector<double> travelled_distances(const MappingInput& input,
                                        const std::vector<Eigen::Isometry3d>& T_map_vehicle) {
  const auto& keyframes = input.odometry.keyframes;
  std::vector<double> travelled_m(keyframes.size(), 0.0);
  for (std::size_t k = 1; k < keyframes.size(); ++k) {
    if (input.session[k] != input.session[k - 1]) continue;
    travelled_m[k] = travelled_m[k - 1];
    if (!keyframes[k].after_gap)
      travelled_m[k] +=
          (T_map_vehicle[k].translation() - T_map_vehicle[k - 1].translation()).norm();
  }
  return travelled_m;
}

}  // namespace roadbook
