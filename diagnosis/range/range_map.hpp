#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

namespace roadbook {

/// One beam of a range sensor at a reference pose, in the plane.
struct RangeBeam {
  double t_s = 0.0;
  std::size_t beam = 0;
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();
  double range_m = 0.0;
  double height_m = 0.0;  ///< of the origin, in the frame of the poses
  double climb = 0.0;     ///< of the beam, per metre
  double speed = 0.0;     ///< of the vehicle [m/s]; constant where it is not known
  double yaw_rate = 0.0;  ///< [rad/s]

  [[nodiscard]] double height_at(double r_m) const { return height_m + climb * r_m; }
};

/// What a beam should meet.
struct MetSurface {
  double range_m = 0.0;
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();  ///< of the line there, either sign
};

// What stands around, from the ends of the beams of a whole drive at its reference poses: a grid
// of cells in which beams ended or which they passed, with the line through the ends near each.
class RangeMap {
 public:
  /// Readings of `max_m` and more tell of no end and are left out.
  RangeMap(const std::vector<RangeBeam>& beams, double max_m, double cell_m = 0.1);

  /// The nearest surface along the beam, judged by the other beams alone. Nothing where
  /// they cannot tell: unknown ground, an edge, a surface seen almost from its side, one that the
  /// others saw at another height (a car that tilts looks over things, or at the floor).
  [[nodiscard]] std::optional<MetSurface> surface(const RangeBeam& beam) const;

 private:
  struct Cell {
    double hits = 0.0;
    double passes = 0.0;
    double heights = 0.0;  ///< sum over the hits
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  };
  /// Null where nothing ended.
  [[nodiscard]] const Cell* at(const Eigen::Vector2d& place) const;
  [[nodiscard]] std::int64_t index_of(const Eigen::Vector2d& place) const;
  [[nodiscard]] bool ended(const RangeBeam& beam) const;
  [[nodiscard]] std::optional<double> first_surface(const RangeBeam& beam,
                                                    const Eigen::Vector2d& origin) const;
  [[nodiscard]] std::optional<MetSurface> at_line(const RangeBeam& beam, double near_m) const;

  double max_m_, cell_m_;
  Eigen::Vector2d low_ = Eigen::Vector2d::Zero();
  std::int64_t width_ = 0, height_ = 0;
  std::vector<std::int32_t> number_;  ///< of the cell at each place of the grid; -1: none
  std::vector<Cell> cells_;
};

}  // namespace roadbook
