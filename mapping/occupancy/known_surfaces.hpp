#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "mapping/occupancy/patch_grid.hpp"

namespace roadbook {

/// Surfaces that the readings of a patch agree on. A reading gives no evidence about the ground
/// behind one: it has lost its echo, or comes from another sensor. Otherwise each wrong reading
/// would free a line of ground behind a wall.
///
/// Echoes lie some decimetres apart on a surface that is far away. Therefore a surface is known
/// around each cell with an echo, up to `kBetweenEchoes_m`, if at least two echoes lie there and
/// the cells that hold them are occupied together: where later readings passed, as of a person who
/// went on, they are less so. The price: posts less than a metre apart hide the ground behind them,
/// as a wall does.
class KnownSurfaces {
 public:
  static constexpr double kBetweenEchoes_m = 0.2;

  /// `first`: the patch after a pass without known surfaces. `cone_rad`: full angle of a wide beam,
  /// whose echoes lie anywhere on an arc, so that the ground around its occupied cells is known; 0:
  /// a ray.
  KnownSurfaces(const PatchGrid& first, double prior_log_odds, double cone_rad);

  /// Distance along a ray behind which nothing changes [m]; infinity if no surface is before the
  /// reading's end. The surface on which the reading itself ends does not count.
  [[nodiscard]] double limit_m(const Eigen::Vector2d& origin,
                               const Eigen::Vector2d& along,
                               double read_m) const;

 private:
  template <typename Visit>
  void for_each_near(int column, int row, int reach, const Visit& visit) const;
  void know_around_echoes(const PatchGrid& first, double threshold, int reach);
  void know_around_occupied(const PatchGrid& first, double threshold, int reach);

  CellShape shape_;
  std::vector<char> known_;
  int own_ = 2;  ///< cells before the end of a reading that belong to its own surface
};

/// Limits over the directions of a wide beam.
class ConeLimits {
 public:
  /// `along`: unit, the axis. `cone_rad`: full angle.
  ConeLimits(const KnownSurfaces& known,
             const CellShape& shape,
             const Eigen::Vector2d& origin,
             const Eigen::Vector2d& along,
             double cone_rad,
             double read_m);

  /// Whether a place [m] in the beam lies before the surfaces.
  [[nodiscard]] bool holds(const Eigen::Vector2d& place) const;

 private:
  Eigen::Vector2d origin_, along_;
  double half_rad_, step_rad_;
  std::vector<double> limits_m_;
};

}  // namespace roadbook
