#include "mapping/pipeline/pass_numbers.hpp"

#include <algorithm>
#include <cmath>

#include "base/cell_grid.hpp"
#include "base/se3.hpp"
#include "mapping/loops/loop_closure.hpp"
#include "mapping/travelled.hpp"

namespace roadbook {

void visit_earlier_passes(const MappingInput& input,
                          const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                          const PlacePassOptions& options,
                          const std::function<void(std::size_t, std::size_t, double)>& visit) {
  const auto& keyframes = input.odometry.keyframes;
  const auto segments = segments_of(keyframes);
  const auto travelled_m = travelled_distances(input, T_map_vehicle);
  CellGrid<std::size_t> earlier(options.radius_m);
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    const Eigen::Vector3d p = T_map_vehicle[k].translation();
    earlier.visit_near(p.head<2>(), [&](std::size_t other) {
      if (segments[other] == segments[k] &&
          travelled_m[k] - travelled_m[other] < options.min_travel_m)
        return;
      const Eigen::Isometry3d T = T_map_vehicle[other].inverse() * T_map_vehicle[k];
      const double distance = T.translation().norm();
      if (std::abs(heading_of(T)) <= options.heading_rad && distance < options.radius_m)
        visit(k, other, distance);
    });
    earlier.insert(p.head<2>(), k);
  }
}

std::vector<int> pass_numbers(const MappingInput& input,
                              const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                              const PlacePassOptions& options) {
  std::vector<int> number(T_map_vehicle.size(), 0);
  visit_earlier_passes(input, T_map_vehicle, options,
                       [&](std::size_t k, std::size_t earlier, double) {
                         number[k] = std::max(number[k], number[earlier] + 1);
                       });
  return number;
}

}  // namespace roadbook
