#include "diagnosis/views/view_basis.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace roadbook {
namespace {

// Typical speeds [m/s], turn rates [rad/s] and accelerations [m/s^2] in a car park, to scale the
// basis functions.
constexpr double kSpeed = 3.0;
constexpr double kTurnRate = 0.3;
constexpr double kAcceleration = 0.5;

Eigen::Vector2d from_middle(const Camera& camera, const Eigen::Vector2d& pixel) {
  return pixel - 0.5 * Eigen::Vector2d(camera.width - 1.0, camera.height - 1.0);
}

}  // namespace

ViewFrame view_frame(const ViewData& data) {
  ViewFrame frame;
  Eigen::Vector2d low(1e300, 1e300);
  Eigen::Vector2d high = -low;
  for (const BundlePose& pose : data.bundle.poses) {
    low = low.cwiseMin(pose.T_map_vehicle.translation().head<2>());
    high = high.cwiseMax(pose.T_map_vehicle.translation().head<2>());
  }
  frame.middle = 0.5 * (low + high);
  frame.reach_m = std::max(1.0, 0.5 * (high - low).maxCoeff());
  frame.end_s = std::max(1.0, data.moments.back().t_s);
  return frame;
}

double covariate_value(std::string_view covariate,
                       const ViewMoment& from,
                       const ViewMoment& to,
                       double end_s) {
  const double speed = 0.5 * (from.speed + to.speed) / kSpeed;
  if (covariate == "speed") return speed;
  if (covariate == "speed squared") return speed * speed;
  if (covariate == "acceleration")
    return 0.5 * (from.acceleration + to.acceleration) / kAcceleration;
  if (covariate == "turn rate") return 0.5 * (from.yaw_rate + to.yaw_rate) / kTurnRate;
  ROADBOOK_ASSERT(covariate == "time");
  return (from.t_s + to.t_s) / end_s - 1.0;
}

Eigen::Vector2d radial_direction(const Camera& camera, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d d = from_middle(camera, pixel);
  const double length = d.norm();
  return length > 1e-9 ? Eigen::Vector2d(d / length) : Eigen::Vector2d(1.0, 0.0);
}

std::array<double, kViewTermCount> view_terms(const ViewFrame& frame,
                                              const Camera& camera,
                                              const Eigen::Vector2d& pixel,
                                              const ViewMoment& moment,
                                              const Eigen::Vector2d& place) {
  const Eigen::Vector2d d = from_middle(camera, pixel) / (0.5 * camera.width);
  const double r = d.norm();
  const Eigen::Vector2d a = radial_direction(camera, pixel);
  const double row = 2.0 * from_middle(camera, pixel).y() / camera.height;
  const double t = 2.0 * moment.t_s / frame.end_s - 1.0;
  const Eigen::Vector2d p = (place - frame.middle) / frame.reach_m;
  return {1.0,
          r,
          r * r,
          r * r * r,
          a.x(),
          a.y(),
          a.x() * a.x() - a.y() * a.y(),
          2.0 * a.x() * a.y(),
          row,
          row * row,
          moment.speed / kSpeed,
          moment.yaw_rate / kTurnRate,
          t,
          t * t,
          p.x(),
          p.y(),
          p.x() * p.x(),
          p.x() * p.y(),
          p.y() * p.y()};
}

}  // namespace roadbook
