#include "diagnosis/views/hinge.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace roadbook {

double HingeLine::height(const Eigen::Vector2d& p) const { return 0.5 * std::abs(distance(p)); }

HingeLine HingeLine::moved(double turn_rad, double shift_m, const Eigen::Vector2d& place) const {
  HingeLine line;
  line.normal = Eigen::Rotation2Dd(turn_rad) * normal;
  line.offset_m = offset_m + (line.normal - normal).dot(place) + shift_m;
  line.pivot = pivot - line.distance(pivot) * line.normal;
  return line;
}

HingePose pose_on_hinge(const HingeLine& line,
                        const Eigen::Isometry3d& T_map_vehicle,
                        const WheelModel& car) {
  const auto under = [&](double ahead, double aside) {
    return line.height((T_map_vehicle * Eigen::Vector3d(ahead, aside, 0.0)).head<2>());
  };
  const double half = 0.5 * car.track_width_m;
  const double rear_left = under(0.0, half);
  const double rear_right = under(0.0, -half);
  const double front_left = under(car.wheelbase_m, half);
  const double front_right = under(car.wheelbase_m, -half);
  HingePose stand;
  stand.rise_ahead = (front_left + front_right - rear_left - rear_right) / (2.0 * car.wheelbase_m);
  stand.rise_aside =
      (rear_left + front_left - rear_right - front_right) / (2.0 * car.track_width_m);
  stand.height = 0.25 * (rear_left + rear_right + front_left + front_right) -
                 0.5 * car.wheelbase_m * stand.rise_ahead;
  return stand;
}

}  // namespace roadbook
