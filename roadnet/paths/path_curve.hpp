#pragma once

#include <Eigen/Core>
#include <vector>

#include "roadnet/paths/bezier_path.hpp"
#include "roadnet/paths/path_piece.hpp"

namespace roadbook {

/// Position, direction, curvature and height of a path at one arc length.
struct PathPoint {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< [m, map frame]
  Eigen::Vector2d tangent = Eigen::Vector2d::UnitX();  ///< unit, in the direction of travel
  double curvature = 0.0;                              ///< [1/m], left turn positive
  double height_m = 0.0;

  [[nodiscard]] double heading() const;  ///< [rad], counter-clockwise from the map's x axis
  [[nodiscard]] Eigen::Vector2d left() const { return {-tangent.y(), tangent.x()}; }
};

/// A path by its arc length: the g(s) of [SPM], whose speed is one everywhere. The parameter of a
/// Bezier segment is not its length: the error is up to half a metre at e = 6 m.
///
/// The path is cut into pieces until a Chebyshev series gives the arc length of each to rounding
/// error. Newton's method on the series gives the inverse. Immutable and safe to share between
/// threads.
class PathCurve {
 public:
  /// Throws BadInput for a path that fails its check or has zero speed somewhere.
  explicit PathCurve(BezierPath path);

  [[nodiscard]] const BezierPath& bezier() const { return path_; }
  [[nodiscard]] double length_m() const { return length_m_; }
  [[nodiscard]] bool closed() const { return path_.closed; }

  /// The point at `s_m`. `s_m` is wrapped around a closed path, and clamped to [0, length] on an
  /// open one.
  [[nodiscard]] PathPoint at(double s_m) const;

  /// `s_m`, wrapped to [0, length) on a closed path, or clamped to [0, length] on an open one.
  [[nodiscard]] double wrapped(double s_m) const;
  /// Distance along the path between two positions; on a closed path, the shorter of both ways.
  [[nodiscard]] double distance_along(double a_m, double b_m) const;

  [[nodiscard]] const std::vector<PathPiece>& pieces() const { return pieces_; }
  /// Index of the piece that holds `s_m` in [0, length].
  [[nodiscard]] std::size_t piece_at(double s_m) const;

 private:
  BezierPath path_;
  std::vector<PathPiece> pieces_;
  double length_m_ = 0.0;
};

/// The position of largest absolute curvature.
struct CurvaturePeak {
  double s_m = 0.0;
  double curvature = 0.0;  ///< [1/m], with its sign
};
/// Finds the peak within [s_begin, s_end], clamped to the path, on a grid of about `step_m`, and
/// refines it.
[[nodiscard]] CurvaturePeak curvature_peak(const PathCurve& curve,
                                           double s_begin_m,
                                           double s_end_m,
                                           double step_m = 0.25);

}  // namespace roadbook
