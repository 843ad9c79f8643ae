#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "roadnet/paths/bezier_path.hpp"

namespace roadbook {

/// A short piece of a path for fast evaluation. The variable v runs from -1 to 1, where powers are
/// well conditioned. Horner's rule takes fewer steps than Bernstein's form.
struct PathPiece {
  struct Derivatives {
    double x, y, dx, dy, ddx, ddy;
  };

  double s_begin_m = 0.0;
  double length_m = 0.0;
  int degree = 0;
  int arc_terms = 0;
  std::array<double, kMaxPathDegree + 1> x{};  ///< coefficients of the powers of v [m]
  std::array<double, kMaxPathDegree + 1> y{};
  std::array<double, kMaxPathDegree + 1> z{};
  std::array<double, 20>
      arc{};  ///< Chebyshev coefficients of the arc length from the piece's begin

  /// Position and its first two derivatives with respect to v.
  [[nodiscard]] Derivatives at(double v) const {
    Derivatives d{x[static_cast<std::size_t>(degree)],
                  y[static_cast<std::size_t>(degree)],
                  0.0,
                  0.0,
                  0.0,
                  0.0};
    for (int k = degree - 1; k >= 0; --k) {
      const auto i = static_cast<std::size_t>(k);
      d.ddx = d.ddx * v + d.dx;
      d.ddy = d.ddy * v + d.dy;
      d.dx = d.dx * v + d.x;
      d.dy = d.dy * v + d.y;
      d.x = d.x * v + x[i];
      d.y = d.y * v + y[i];
    }
    d.ddx *= 2.0;
    d.ddy *= 2.0;
    return d;
  }
  /// Arc length from the piece's begin to v [m].
  [[nodiscard]] double arc_at(double v) const {
    double b1 = 0.0;
    double b2 = 0.0;
    for (int k = arc_terms - 1; k > 0; --k) {
      const double b = 2.0 * v * b1 - b2 + arc[static_cast<std::size_t>(k)];
      b2 = b1;
      b1 = b;
    }
    return v * b1 - b2 + arc[0];
  }
  /// The v at an arc length from the piece's begin, by Newton's method.
  [[nodiscard]] double v_at(double arc_m) const;
};

/// Cuts a path into pieces with a small turn angle and an arc length that is exact to rounding
/// error. Throws BadInput if the path has a point of zero speed.
[[nodiscard]] std::vector<PathPiece> cut_into_pieces(const BezierPath& path);

}  // namespace roadbook
