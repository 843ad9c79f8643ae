#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

#include "sim/scenario/scenario.hpp"

namespace roadbook {

// The shape of the driven surface: flat, or two planes that meet in a hinge line, or flat storeys
// that ramps join, plus the named effects on it. Also the pose of a car on this surface.

/// Effects on the ground (sensors/effects.hpp): all 0 when off.
struct GroundEffects {
  double height_m = 0.0;  ///< the whole ground lies higher than z = 0
  double hinge = 0.0;     ///< added to the change of slope at the hinge line [rad]
};

/// Corners of the ramps' rectangle in the plane.
[[nodiscard]] Eigen::AlignedBox2d ramp_area(const StoreySpec& storeys);

class Ground {
 public:
  explicit Ground(const GroundSpec& spec, const GroundEffects& effects = {});

  /// Height [m] over z = 0. Continuous, piecewise plane. Of several storeys that whose height is
  /// nearest to `near_m`.
  [[nodiscard]] double height(double x, double y, double near_m = 0.0) const;
  /// Upward unit normal; on the hinge itself that of its left side.
  [[nodiscard]] Eigen::Vector3d normal(double x, double y) const;
  /// Signed distance to the left of the hinge line; 0 without one.
  [[nodiscard]] double hinge_distance(double x, double y) const;
  [[nodiscard]] bool hinged() const { return hinged_; }

  /// Pose of a car whose origin is over (x, y): its plane is the least-squares plane through the
  /// four points where the wheels stand. Of several storeys that whose height is nearest to
  /// `near_m`.
  [[nodiscard]] Eigen::Isometry3d stand(double x,
                                        double y,
                                        double heading,
                                        double wheelbase_m,
                                        double track_width_m,
                                        double near_m = 0.0) const;

 private:
  bool hinged_ = false;
  Eigen::Vector2d hinge_point_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d hinge_left_ = Eigen::Vector2d::Zero();  ///< unit, to the left of from -> to
  double hinge_slope_ = 0.0;
  double height_m_ = 0.0;
  std::optional<StoreySpec> storeys_;
};

}  // namespace roadbook
