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
                          const std::function<void(const EarlierPass&)>& visit) {
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
      if (std::abs(heading_of(T)) <= options.heading_rad &&
          T.translation().norm() < options.radius_m)
        visit({k, other, T.translation()});
    });
    earlier.insert(p.head<2>(), k);
  }
}

std::vector<int> pass_numbers(const MappingInput& input,
                              const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                              const std::vector<int>& piece,
                              const std::vector<bool>& counts,
                              const PlacePassOptions& options) {
  constexpr double kBeside_m = 0.5;
  constexpr double kBesideSpacings = 0.6;
  std::vector<int> number(T_map_vehicle.size(), 0);
  std::vector<bool> is_beside(T_map_vehicle.size(), false);
  visit_earlier_passes(input, T_map_vehicle, options, [&](const EarlierPass& pair) {
    const std::size_t k = pair.keyframe;
    if (!counts[pair.earlier] || piece[pair.earlier] != piece[k]) return;
    const double spacing =
        k == 0 ? 0.0 : (T_map_vehicle[k].translation() - T_map_vehicle[k - 1].translation()).norm();
    const bool beside = std::abs(pair.way_m.x()) <= std::max(kBeside_m, kBesideSpacings * spacing);
    // Farther ahead lie keyframes of the own pass, where it ends as a ring.
    if (is_beside[k] && !beside) return;
    const int next = number[pair.earlier] + 1;
    number[k] = beside && !is_beside[k] ? next : std::max(number[k], next);
    is_beside[k] = beside;
  });
  return number;
}

}  // namespace roadbook
