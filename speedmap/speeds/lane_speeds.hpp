#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "roadnet/paths/lane_path.hpp"
#include "roadnet/paths/path_curve.hpp"
#include "speedmap/presence/presence_grid.hpp"
#include "speedmap/property_map/property_map.hpp"
#include "speedmap/speeds/speed_profile.hpp"

namespace roadbook {

// Recommended speed along a way: the lowest of the limits by law, people, bends and grip, made into
// a profile that the vehicle can follow.

struct LaneSpeedOptions {
  double min_speed = 1.0;  ///< [m/s] where a person is met at every visit
  double max_speed =
      30 / 3.6;  ///< [m/s] where nobody is; also the limit of lanes without their own
  /// Standard deviations of presence that are added to it: 0 as in the document.
  double caution = 0.0;
  /// Grip is counted upon that the road has with probability 1 - quantile.
  double grip_quantile = 0.05;
  /// Share of the grip used in each direction: braking in a bend needs both (0.7 each: the circle).
  double grip_share = 0.7;
  /// Friction counted upon where the map knows none; 0: nothing is assumed, and grip limits nothing
  /// there.
  double unknown_grip = 0.0;
  double sight_m = 15.0;         ///< the vehicle can stop within this
  double reaction_s = 0.5;       ///< before it brakes
  double vehicle_width_m = 1.9;  ///< places under the vehicle count, the worst of them
  double step_m = 0.25;
  MotionLimits motion;

  /// Throws InvalidOption.
  void check() const;
};

/// Presence at a place of the map frame [m]; empty where the dynamic map has no place.
using PresenceAt = std::function<std::optional<PresenceValue>(const Eigen::Vector2d&)>;
/// Friction at a distance from the way; empty where it is unknown.
using FrictionAt = std::function<std::optional<PropertyMoments>(double s_m, double e_m)>;

/// The way at one place, as a profile needs it.
struct WayPoint {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  Eigen::Vector2d left = Eigen::Vector2d::UnitY();
  double curvature = 0.0;
};

/// What a speed is not to go above; kMotion: braking for, or pulling away from, a slower place.
enum class SpeedLimitedBy : std::uint8_t { kLaw, kBend, kPedestrian, kGrip, kMotion };

/// One place of a profile. Speeds without a limit are infinite; unknown means are NaN.
struct LaneSpeed {
  double s_m = 0.0;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  double limit = 0.0;       ///< [m/s] of the lane
  double pedestrian = 0.0;  ///< [m/s] recommended by presence under the vehicle
  double bend = 0.0;        ///< [m/s] by lateral acceleration
  double grip = 0.0;        ///< [m/s] by friction at its quantile: bend and stopping within sight
  double grip_acceleration = 0.0;  ///< [m/s^2] left along the way
  double speed = 0.0;              ///< [m/s] of the profile
  double presence = 0.0;           ///< largest under the vehicle
  double presence_sigma = 0.0;     ///< there
  double friction = 0.0;           ///< mean where grip is least
  double friction_sigma = 0.0;
  [[nodiscard]] double ceiling() const;
  [[nodiscard]] SpeedLimitedBy limited_by() const;
};

inline constexpr double kLeastFriction = 0.02;  ///< Ice; a quantile below is not believed.

/// Speed at which friction `mu` holds in a bend and stops within sight.
[[nodiscard]] double grip_speed(double mu, double curvature, const LaneSpeedOptions& options);

/// The same for friction at its quantile, with the deviation that the speed has from friction's.
struct GripSpeed {
  double friction = 0.0;  ///< the quantile
  double speed = 0.0;
  double sigma = 0.0;
};
[[nodiscard]] GripSpeed grip_speed_of(const PropertyMoments& friction,
                                      double curvature,
                                      const LaneSpeedOptions& options);

/// What limits the speed at places of a way, `speed` set to the ceiling. `s_m` in the terms of
/// `friction`; either source may be empty.
[[nodiscard]] std::vector<LaneSpeed> speed_limits_along(const std::vector<WayPoint>& way,
                                                        const std::vector<double>& s_m,
                                                        double limit,
                                                        const PresenceAt& presence,
                                                        const FrictionAt& friction,
                                                        const LaneSpeedOptions& options);
/// Sets `speed` to the profile. `step_m`: between the places.
void make_feasible(std::vector<LaneSpeed>& places,
                   double step_m,
                   bool closed,
                   const LaneSpeedOptions& options);

/// Places about `step_m` apart over a curve, the last at its end (of a ring: before its seam).
[[nodiscard]] std::vector<double> even_places(const PathCurve& curve, double step_m);
[[nodiscard]] std::vector<WayPoint> way_points(const PathCurve& curve,
                                               const std::vector<double>& s_m);

/// The profile of a lane.
struct LaneProfile {
  std::uint64_t lane = 0;
  double step_m = 0.0;
  bool closed = false;
  int from_intersection = -1;
  int to_intersection = -1;
  std::vector<LaneSpeed> places;

  /// Profile speed at s and its slope ds/dv; linear between places.
  [[nodiscard]] double speed_at(double s_m, double* slope = nullptr) const;
};

/// Lowers the profiles until those that meet at an intersection have one speed there.
void agree_at_intersections(std::vector<LaneProfile>& profiles, const LaneSpeedOptions& options);

}  // namespace roadbook
