#include "sim/world/ground.hpp"

#include <algorithm>
#include <cmath>

namespace roadbook {

namespace {

// Share of the ramp's rise at a place; 0 beside the ramp.
double ramp_share(const StoreySpec& storeys, const Eigen::Vector2d& place) {
  if (!ramp_area(storeys).contains(place)) return 0.0;
  const Eigen::Vector2d along = storeys.ramp_to - storeys.ramp_from;
  return along.dot(place - storeys.ramp_from) / along.squaredNorm();
}

}  // namespace

Eigen::AlignedBox2d ramp_area(const StoreySpec& storeys) {
  const Eigen::Vector2d along = (storeys.ramp_to - storeys.ramp_from).normalized();
  const Eigen::Vector2d half = 0.5 * storeys.ramp_width_m * Eigen::Vector2d(-along.y(), along.x());
  Eigen::AlignedBox2d area(storeys.ramp_from + half);
  area.extend(Eigen::Vector2d(storeys.ramp_from - half));
  area.extend(Eigen::Vector2d(storeys.ramp_to + half));
  area.extend(Eigen::Vector2d(storeys.ramp_to - half));
  return area;
}

Ground::Ground(const GroundSpec& spec, const GroundEffects& effects)
    : height_m_(effects.height_m), storeys_(spec.storeys) {
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

double Ground::height(double x, double y, double near_m) const {
  const double floor = height_m_ + hinge_slope_ * std::abs(hinge_distance(x, y));
  if (!storeys_) return floor;
  const double share = ramp_share(*storeys_, {x, y});
  const int highest = storeys_->count - (share > 0.0 ? 2 : 1);
  const double storey = std::round((near_m - floor) / storeys_->height_m - share);
  return floor +
         storeys_->height_m * (share + std::clamp(storey, 0.0, static_cast<double>(highest)));
}

Eigen::Vector3d Ground::normal(double x, double y) const {
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  if (hinged_)
    gradient += (hinge_distance(x, y) >= 0.0 ? hinge_slope_ : -hinge_slope_) * hinge_left_;
  return Eigen::Vector3d(-gradient.x(), -gradient.y(), 1.0).normalized();
}

Eigen::Isometry3d Ground::stand(double x,
                                double y,
                                double heading,
                                double wheelbase_m,
                                double track_width_m,
                                double near_m) const {
  const Eigen::Vector2d forward(std::cos(heading), std::sin(heading));
  const Eigen::Vector2d left(-forward.y(), forward.x());
  const auto under = [&](double ahead, double aside) {
    const Eigen::Vector2d p = Eigen::Vector2d(x, y) + ahead * forward + aside * left;
    return height(p.x(), p.y(), near_m);
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
