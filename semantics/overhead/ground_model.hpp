#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "mapping/map.hpp"

namespace roadbook {

// Height of the driven surface over the xy plane of the map. One plane is not enough for a ramp: a
// bend of 2 degrees changes the height by 35 cm over 10 m, and shifts distant ground points of a
// low camera by much more.
//
// The surface is a thin plate on a sparse grid: it bends as little as the measurements allow.
// Planes are extrapolated as planes, and a sharp bend is smoothed over about one cell.

/// A point known to lie on the ground.
struct GroundPoint {
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();
  double sigma_m = 0.02;  ///< standard deviation of its height
};

struct GroundModelOptions {
  double spacing_m = 1.0;          ///< of the grid nodes
  double reach_m = 12.0;           ///< the surface is defined within this distance of `around`
  double sigma_bend_rad = 0.02;    ///< expected change of slope from one cell to the next
  double sigma_wheel_m = 0.01;     ///< height of a wheel's contact point
  double sigma_landmark_m = 0.03;  ///< smallest standard deviation of a ground landmark's height
  /// Positions of the wheels for sessions whose vehicle is unknown.
  double wheelbase_m = 2.6;
  double track_width_m = 1.5;

  /// Throws InvalidOption.
  void check() const;
};

/// Height as a function of (x, y) in the map frame. A plain value; const members are thread-safe.
class GroundModel {
 public:
  /// The plane z = z0 + slope . (x, y), everywhere.
  static GroundModel plane(double z0_m = 0.0,
                           const Eigen::Vector2d& slope = Eigen::Vector2d::Zero());

  /// Fits the surface to `points` (robust: Cauchy weights) within `reach_m` of `around`. Cells
  /// without measurements continue the slope of their neighbours. Deterministic. With an empty
  /// `around` the height is unknown everywhere.
  static GroundModel fit(const std::vector<GroundPoint>& points,
                         const std::vector<Eigen::Vector2d>& around,
                         const GroundModelOptions& options = {});

  /// Height [m] at map coordinates; empty outside the surface.
  [[nodiscard]] std::optional<double> height(double x, double y) const;

 private:
  double z0_m_ = 0.0;
  Eigen::Vector2d slope_ = Eigen::Vector2d::Zero();
  double spacing_m_ = 0.0;  ///< 0: a plane
  std::unordered_map<std::int64_t, double> nodes_;
};

/// Ground points of a map: the four wheel contacts at every keyframe (the vehicle frame lies on the
/// ground below the rear axle), and landmarks marked as ground.
[[nodiscard]] std::vector<GroundPoint> ground_points(const Map& map,
                                                     const GroundModelOptions& options = {});
[[nodiscard]] GroundModel estimate_ground(const Map& map, const GroundModelOptions& options = {});

}  // namespace roadbook
