#include "roadnet/paths/path_curve.hpp"

#include <algorithm>
#include <cmath>

namespace roadbook {

double PathPoint::heading() const { return std::atan2(tangent.y(), tangent.x()); }

PathCurve::PathCurve(BezierPath path) : path_(std::move(path)), pieces_(cut_into_pieces(path_)) {
  length_m_ = pieces_.back().s_begin_m + pieces_.back().length_m;
}

double PathCurve::wrapped(double s_m) const {
  if (!closed()) return std::clamp(s_m, 0.0, length_m_);
  const double s = s_m - length_m_ * std::floor(s_m / length_m_);
  return s < length_m_ ? s : 0.0;  // a tiny negative number rounds up to the length
}

double PathCurve::distance_along(double a_m, double b_m) const {
  const double d = std::abs(a_m - b_m);
  if (!closed()) return d;
  const double round = std::fmod(d, length_m_);
  return std::min(round, length_m_ - round);
}

std::size_t PathCurve::piece_at(double s_m) const {
  const auto after =
      std::upper_bound(pieces_.begin() + 1, pieces_.end(), s_m,
                       [](double s, const PathPiece& piece) { return s < piece.s_begin_m; });
  return static_cast<std::size_t>(after - pieces_.begin()) - 1;
}

PathPoint PathCurve::at(double s_m) const {
  const double s = wrapped(s_m);
  const PathPiece& piece = pieces_[piece_at(s)];
  const double v = piece.v_at(s - piece.s_begin_m);
  const auto d = piece.at(v);
  const double speed = std::sqrt(d.dx * d.dx + d.dy * d.dy);
  PathPoint point;
  point.position = {d.x, d.y};
  point.tangent = Eigen::Vector2d(d.dx, d.dy) / speed;
  point.curvature = (d.dx * d.ddy - d.dy * d.ddx) / (speed * speed * speed);
  for (int k = piece.degree; k >= 0; --k)
    point.height_m = point.height_m * v + piece.z[static_cast<std::size_t>(k)];
  return point;
}

CurvaturePeak curvature_peak(const PathCurve& curve,
                             double s_begin_m,
                             double s_end_m,
                             double step_m) {
  const auto size = [&](double s) { return std::abs(curve.at(s).curvature); };
  const int steps = std::max(4, static_cast<int>(std::ceil((s_end_m - s_begin_m) / step_m)));
  const double h = (s_end_m - s_begin_m) / steps;
  int best = 0;
  for (int i = 1; i <= steps; ++i)
    if (size(s_begin_m + h * i) > size(s_begin_m + h * best)) best = i;
  // Golden section in the two steps next to the best one.
  double a = std::max(s_begin_m, s_begin_m + h * (best - 1));
  double b = std::min(s_end_m, s_begin_m + h * (best + 1));
  constexpr double kGolden = 0.6180339887498949;
  while (b - a > 1e-7) {
    const double c = b - kGolden * (b - a);
    const double d = a + kGolden * (b - a);
    (size(c) > size(d) ? b : a) = size(c) > size(d) ? d : c;
  }
  const double inside = 0.5 * (a + b);
  const double on_grid = s_begin_m + h * best;
  const double s = size(inside) > size(on_grid) ? inside : on_grid;
  return {s, curve.at(s).curvature};
}

}  // namespace roadbook
