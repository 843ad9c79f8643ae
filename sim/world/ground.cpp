#include "sim/world/ground.hpp"

#include <cmath>

namespace roadbook {

Ground::Ground(const GroundSpec& spec, const GroundEffects& effects) : height_m_(effects.height_m) {
  const bool new_hinge = !spec.hinge && effects.hinge != 0.0;
  if (!spec.hinge && !new_hinge) return;
  // A place without a hinge gets one through its middle, along x.
  const Eigen::Vector2d middle = 0.5 * (spec.low + spec.high);
  const Eigen::Vector2d from = spec.hinge ? spec.hinge->from : middle;
  const Eigen::Vector2d along =
      (spec.hinge ? Eigen::Vector2d(spec.hinge->to - from) : Eigen::Vector2d(1.0, 0.0))
          .normalized();
  hinged_ = true;
  hinge_point_ = from;
  hinge_left_ = {-along.y(), along.x()};
  hinge_slope_ = std::tan(std::atan(spec.hinge ? spec.hinge->slope : 0.0) + 0.5 * effects.hinge);
}

double Ground::hinge_distance(double x, double y) const {
  return hinged_ ? hinge_left_.dot(Eigen::Vector2d(x, y) - hinge_point_) : 0.0;
}

double Ground::height(double x, double y) const {
  return height_m_ + hinge_slope_ * std::abs(hinge_distance(x, y));
}

Eigen::Vector3d Ground::normal(double x, double y) const {
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  if (hinged_)
    gradient += (hinge_distance(x, y) >= 0.0 ? hinge_slope_ : -hinge_slope_) * hinge_left_;
  return Eigen::Vector3d(-gradient.x(), -gradient.y(), 1.0).normalized();
}

Eigen::Isometry3d Ground::stand(
    double x, double y, double heading, double wheelbase_m, double track_width_m) const {
  const Eigen::Vector2d forward(std::cos(heading), std::sin(heading));
  const Eigen::Vector2d left(-forward.y(), forward.x());
  const auto under = [&](double ahead, double aside) {
    const Eigen::Vector2d p = Eigen::Vector2d(x, y) + ahead * forward + aside * left;
    return height(p.x(), p.y());
  };
  const double half = 0.5 * track_width_m;
  const double rear_left = under(0.0, half);
  const double rear_right = under(0.0, -half);
  const double front_left = under(wheelbase_m, half);
  const double front_right = under(wheelbase_m, -half);
  // Least squares over a rectangle separates: mean height, slope ahead, slope aside.
  const double rise_ahead =
      (front_left + front_right - rear_left - rear_right) / (2.0 * wheelbase_m);
  const double rise_aside =
      (rear_left + front_left - rear_right - front_right) / (2.0 * track_width_m);
  const double mean = 0.25 * (rear_left + rear_right + front_left + front_right);
  const Eigen::Vector3d x_axis = Eigen::Vector3d(forward.x(), forward.y(), rise_ahead).normalized();
  const Eigen::Vector3d y_raw(left.x(), left.y(), rise_aside);
  const Eigen::Vector3d z_axis = x_axis.cross(y_raw).normalized();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear().col(0) = x_axis;
  T.linear().col(1) = z_axis.cross(x_axis);
  T.linear().col(2) = z_axis;
  T.translation() = Eigen::Vector3d(x, y, mean - 0.5 * wheelbase_m * rise_ahead);
  return T;
}

}  // namespace roadbook
