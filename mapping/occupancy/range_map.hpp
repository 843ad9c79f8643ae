#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

namespace roadbook {

/// One beam of a range sensor at a reference pose, in the horizontal plane.
struct RangeBeam {
  double t_s = 0.0;
  std::size_t beam = 0;
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();
  double range_m = 0.0;
  double height_m = 0.0;  ///< of the origin, frame of the poses
  double climb = 0.0;     ///< rise of the beam per metre of range
  double speed = 0.0;     ///< of the vehicle [m/s]; constant if unknown
  double yaw_rate = 0.0;  ///< [rad/s]

  [[nodiscard]] double height_at(double r_m) const { return height_m + climb * r_m; }
};

/// The surface that a beam should hit.
struct ExpectedSurface {
  double range_m = 0.0;
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();  ///< of the surface line, either sign
};

// Map of the surroundings from the beam ends of a whole drive at its reference poses. A grid of
// cells counts the beams that ended in a cell or passed it, and holds a line fitted to the ends.
class RangeMap {
 public:
  /// `max_m` [m]: readings from here on have no end and are left out. `cell_m` [m]: cell size.
  RangeMap(const std::vector<RangeBeam>& beams, double max_m, double cell_m = 0.1);

  /// The nearest surface along the beam, from the other beams alone. No value if they cannot
  /// determine it: unknown ground, an edge, grazing incidence, or ends at another height (a tilted
  /// car looks over objects or at the floor).
  [[nodiscard]] std::optional<ExpectedSurface> surface(const RangeBeam& beam) const;

 private:
  struct Cell {
    double hits = 0.0;
    double passes = 0.0;
    double heights = 0.0;  ///< sum of the heights of the hits
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  };
  /// Null if no beam ended there.
  [[nodiscard]] const Cell* at(const Eigen::Vector2d& place) const;
  [[nodiscard]] std::int64_t index_of(const Eigen::Vector2d& place) const;
  [[nodiscard]] bool ended(const RangeBeam& beam) const;
  [[nodiscard]] std::optional<double> first_surface(const RangeBeam& beam,
                                                    const Eigen::Vector2d& origin) const;
  [[nodiscard]] std::optional<ExpectedSurface> at_line(const RangeBeam& beam, double near_m) const;

  double max_m_, cell_m_;
  Eigen::Vector2d low_ = Eigen::Vector2d::Zero();
  std::int64_t width_ = 0, height_ = 0;
  std::vector<std::int32_t> number_;  ///< index in `cells_` for each grid position; -1: none
  std::vector<Cell> cells_;
};

}  // namespace roadbook
