#include "workflows/people/seen_share.hpp"

#include <algorithm>
#include <cmath>

#include "base/se3.hpp"

namespace roadbook {
namespace {

constexpr double kBodyBreadth_m = 0.5;  // including the arms
constexpr int kBodyColumns = 5;
constexpr int kBodyRows = 12;

bool hides(const PersonInView& nearer, double azimuth, double slope) {
  return std::abs(wrap_angle(azimuth - nearer.box.azimuth)) <
             0.5 * kBodyBreadth_m / nearer.range_m &&
         slope > nearer.box.foot_slope && slope < nearer.box.foot_slope + nearer.box.size;
}

}  // namespace

PersonInView person_in_view(int camera,
                            const MountedCamera& mounted,
                            const Eigen::Vector3d& foot_vehicle,
                            double height_m) {
  const Eigen::Vector3d eye = mounted.T_vehicle_camera.translation();
  return {box_of_person(camera, mounted, foot_vehicle, height_m),
          std::max((foot_vehicle - eye).head<2>().norm(), 1e-3)};
}

double seen_share(const PersonInView& person,
                  const std::vector<PersonInView>& others,
                  const MountedCamera& mounted,
                  const Eigen::Isometry3d& T_world_vehicle,
                  const std::vector<SightBlocker>& blockers) {
  const Eigen::Vector3d eye = mounted.T_vehicle_camera.translation();
  const Eigen::Vector2d from = (T_world_vehicle * eye).head<2>();
  int seen = 0;
  for (int column = 0; column < kBodyColumns; ++column) {
    const double aside_m = kBodyBreadth_m * ((column + 0.5) / kBodyColumns - 0.5);
    const double azimuth = person.box.azimuth + aside_m / person.range_m;
    const Eigen::Vector3d place =
        eye + person.range_m * Eigen::Vector3d(std::cos(azimuth), std::sin(azimuth), 0.0);
    if (!in_sight(from, (T_world_vehicle * place).head<2>(), blockers)) continue;
    for (int row = 0; row < kBodyRows; ++row) {
      const double slope = person.box.foot_slope + person.box.size * (row + 0.5) / kBodyRows;
      if (std::none_of(others.begin(), others.end(), [&](const PersonInView& other) {
            return other.range_m < person.range_m && hides(other, azimuth, slope);
          }))
        ++seen;
    }
  }
  return static_cast<double>(seen) / (kBodyColumns * kBodyRows);
}

}  // namespace roadbook
