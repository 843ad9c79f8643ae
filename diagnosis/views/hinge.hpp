#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "base/se3.hpp"
#include "sensors/wheels.hpp"

namespace roadbook {

// Ground made of two half-planes that meet in a line (the hinge), per radian of the change of slope
// across the line. First-order model: each half-plane rises by half of the angle. Source: ground
// model with a hinge line, as in the Zurich scenario of the simulator.

/// The line of points p with normal . p = offset, in the plane of the map frame.
struct HingeLine {
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();
  double offset_m = 0.0;
  /// Point of the line about which a fit turns it: the middle of the places where the drive crosses
  /// the line. A turn about another point would move the line away from the observed crossings.
  Eigen::Vector2d pivot = Eigen::Vector2d::Zero();

  /// Signed distance [m] of a map point from the line, positive on the side of the normal.
  [[nodiscard]] double distance(const Eigen::Vector2d& p) const { return normal.dot(p) - offset_m; }
  /// Height of the ground at a map point, per radian of the hinge [m/rad].
  [[nodiscard]] double height(const Eigen::Vector2d& p) const;
  /// The line turned by `turn_rad` about its pivot and then shifted by `shift_m` along its normal.
  [[nodiscard]] HingeLine moved(double turn_rad, double shift_m) const {
    return moved(turn_rad, shift_m, pivot);
  }
  /// The same, turned about `place`. The pivot of the result is a point of the new line.
  [[nodiscard]] HingeLine moved(double turn_rad,
                                double shift_m,
                                const Eigen::Vector2d& place) const;
};

/// Columns of one hinge: the derivative by its size [1/rad]; and, per radian of its size, the
/// derivatives by a turn of the line about its pivot [1/rad] and by a shift [1/m].
inline constexpr std::size_t kHingeColumns = 3;

/// The three columns of a hinge for a vector-valued function of the line. `change(line)` returns a
/// vector of `Rows` values per radian of hinge. The derivatives by turn and shift are central
/// differences.
template <int Rows, typename Change>
[[nodiscard]] Eigen::Matrix<double, Rows, 3> hinge_columns(const HingeLine& line,
                                                           const Change& change) {
  constexpr double kTurn = 0.002;  // [rad]
  constexpr double kShift = 0.05;  // [m]
  const auto by = [&](double turn, double shift) -> Eigen::Vector<double, Rows> {
    return change(line.moved(turn, shift));
  };
  Eigen::Matrix<double, Rows, 3> columns;
  columns.col(0) = change(line);
  columns.col(1) = (by(kTurn, 0.0) - by(-kTurn, 0.0)) / (2.0 * kTurn);
  columns.col(2) = (by(0.0, kShift) - by(0.0, -kShift)) / (2.0 * kShift);
  return columns;
}

/// Pose of a car on hinged ground relative to flat ground, per radian of the hinge. The car's plane
/// is the least-squares plane through its four wheel contact points.
struct HingePose {
  double height = 0.0;      ///< height of the middle of the rear axle [m/rad]
  double rise_ahead = 0.0;  ///< slope of the vehicle's x axis [1/rad]
  double rise_aside = 0.0;  ///< slope of the vehicle's y axis [1/rad]

  [[nodiscard]] Vector6d perturbation() const {
    Vector6d xi;
    xi << 0.0, 0.0, height, rise_aside, -rise_ahead, 0.0;
    return xi;
  }
};
[[nodiscard]] HingePose pose_on_hinge(const HingeLine& line,
                                      const Eigen::Isometry3d& T_map_vehicle,
                                      const WheelModel& car);

}  // namespace roadbook
