#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "mapping/map.hpp"

namespace roadbook {

// Height of the driven surface over the map's xy plane. One plane is not enough where a floor is
// hinged: 2 degrees over 10 m are 35 cm of height, and much more on the ground beyond a low camera.
//
// The surface is a sheet on a sparse grid that bends as little as the evidence allows (discrete
// thin plate): planes stay planes when extrapolated, and a hinge becomes a bend of about one cell.

/// A point known to lie on the ground.
struct GroundPoint {
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();
  double sigma_m = 0.02;  ///< standard deviation of its height
};

struct GroundModelOptions {
  double spacing_m = 1.0;          ///< of the grid
  double reach_m = 12.0;           ///< the surface is modelled this far around each `around` point
  double sigma_bend_rad = 0.02;    ///< expected change of slope from one cell to the next
  double sigma_wheel_m = 0.01;     ///< height of a wheel's contact point
  double sigma_landmark_m = 0.03;  ///< least height error of a ground landmark
  /// Where a session knows no wheels, the contact points are taken as here.
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

  /// Sheet through `points` (robust: Cauchy weights), defined within reach of `around`. Where a
  /// place holds no evidence the sheet continues from its neighbours. Deterministic. Empty `around`
  /// gives a model that knows no height anywhere.
  static GroundModel fit(const std::vector<GroundPoint>& points,
                         const std::vector<Eigen::Vector2d>& around,
                         const GroundModelOptions& options = {});

  /// Height [m]; empty out of reach.
  [[nodiscard]] std::optional<double> height(double x, double y) const;

 private:
  double z0_m_ = 0.0;
  Eigen::Vector2d slope_ = Eigen::Vector2d::Zero();
  double spacing_m_ = 0.0;  ///< 0: a plane
  std::unordered_map<std::int64_t, double> nodes_;
};

/// What the map says of the ground: the four wheels stand on it at every keyframe (the vehicle
/// frame lies on the ground under the rear axle), and landmarks marked as ground lie on it.
[[nodiscard]] std::vector<GroundPoint> ground_points(const Map& map,
                                                     const GroundModelOptions& options = {});
[[nodiscard]] GroundModel estimate_ground(const Map& map, const GroundModelOptions& options = {});

}  // namespace roadbook
