#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "roadnet/paths/lane_path.hpp"
#include "roadnet/paths/path_curve.hpp"
#include "speedmap/presence/presence_grid.hpp"
#include "speedmap/property_map/property_map.hpp"
#include "speedmap/speeds/speed_profile.hpp"

namespace roadbook {

// Recommended speed along a path: the lowest of the limits by law, people, bends and grip, reduced
// to a profile that the vehicle can follow.

struct LaneSpeedOptions {
  double min_speed = 1.0;  ///< [m/s] where a person is met at every visit
  double max_speed =
      30 / 3.6;  ///< [m/s] where nobody is; also the limit of lanes without their own
  /// This many standard deviations of presence are added to presence; 0 as in the paper.
  double caution = 0.0;
  /// The grip used is this quantile of friction: the road has it with probability 1 - quantile.
  double grip_quantile = 0.05;
  /// Share of the grip used along and across. Braking in a bend needs both; 0.7 each stays within
  /// the friction circle.
  double grip_share = 0.7;
  /// Friction assumed where the map has none; 0: grip does not limit the speed there.
  double unknown_grip = 0.0;
  double sight_m = 15.0;         ///< distance within which the vehicle can stop
  double reaction_s = 0.5;       ///< time before it brakes
  double vehicle_width_m = 1.9;  ///< the largest presence within this width counts
  double step_m = 0.25;
  MotionLimits motion;

  /// Throws InvalidOption.
  void check() const;
};

/// Presence at a point of the map frame [m]; empty where the dynamic map has no cell.
using PresenceAt = std::function<std::optional<PresenceValue>(const Eigen::Vector2d&)>;
/// Friction at path coordinates (s, e); empty if unknown.
using FrictionAt = std::function<std::optional<PropertyMoments>(double s_m, double e_m)>;

/// Position, left normal and curvature [1/m] of a path at one point, as a profile needs them.
struct WayPoint {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  Eigen::Vector2d left = Eigen::Vector2d::UnitY();
  double curvature = 0.0;
};

/// The limit that determines a speed. kMotion: braking before, or accelerating after, a slower
/// position. kItem: road works, a queue, wet ground and the like.
enum class SpeedLimitedBy : std::uint8_t { kLaw, kBend, kPedestrian, kGrip, kMotion, kItem };

/// One position of a profile. Speeds without a limit are infinite; unknown means are NaN.
struct LaneSpeed {
  double s_m = 0.0;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  double limit = 0.0;       ///< [m/s] of the lane
  double pedestrian = 0.0;  ///< [m/s] recommended by presence under the vehicle
  double bend = 0.0;        ///< [m/s] by lateral acceleration
  double grip = 0.0;        ///< [m/s] by friction at its quantile: bend and stopping within sight
  double grip_acceleration = 0.0;  ///< [m/s^2] available along the path
  double speed = 0.0;              ///< [m/s] of the profile
  double presence = 0.0;           ///< largest under the vehicle
  double presence_sigma = 0.0;     ///< its standard deviation
  double friction = 0.0;           ///< mean at the position with the least grip
  double friction_sigma = 0.0;
  double item = std::numeric_limits<double>::infinity();  ///< [m/s] by the items of the place
  double item_sigma = 0.0;                                ///< its standard deviation
  double item_grip = 1.0;  ///< factor of items on friction; not in `grip`, which is without items
  [[nodiscard]] double ceiling() const;
  [[nodiscard]] SpeedLimitedBy limited_by() const;
};

inline constexpr double kLeastFriction = 0.02;  ///< ice; a lower quantile is raised to this

/// Largest speed [m/s] at which friction `mu` holds in a bend of `curvature` [1/m] and stops the
/// vehicle within sight.
[[nodiscard]] double grip_speed(double mu, double curvature, const LaneSpeedOptions& options);

/// The same for friction at its quantile, with the standard deviation that follows from friction's.
struct GripSpeed {
  double friction = 0.0;  ///< the quantile
  double speed = 0.0;
  double sigma = 0.0;
};
[[nodiscard]] GripSpeed grip_speed_of(const PropertyMoments& friction,
                                      double curvature,
                                      const LaneSpeedOptions& options);

/// Computes all limits at positions of a path, and sets `speed` to the lowest. `s_m`: s of each
/// position, for `friction`. `limit`: of the lane [m/s]. `presence` and `friction` may be empty.
[[nodiscard]] std::vector<LaneSpeed> speed_limits_along(const std::vector<WayPoint>& way,
                                                        const std::vector<double>& s_m,
                                                        double limit,
                                                        const PresenceAt& presence,
                                                        const FrictionAt& friction,
                                                        const LaneSpeedOptions& options);
/// Sets `speed` to the profile that the vehicle can follow. `step_m`: distance between positions.
void make_feasible(std::vector<LaneSpeed>& places,
                   double step_m,
                   bool closed,
                   const LaneSpeedOptions& options);

/// Returns s at about every `step_m` of a curve, the last at its end (of a ring: before its start).
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

  /// Profile speed at s [m/s] and, if `slope` is not null, its derivative by s; linear between
  /// positions.
  [[nodiscard]] double speed_at(double s_m, double* slope = nullptr) const;
};

/// Lowers the profiles until those that meet at an intersection have one speed there.
void agree_at_intersections(std::vector<LaneProfile>& profiles, const LaneSpeedOptions& options);

}  // namespace roadbook
