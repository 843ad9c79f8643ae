#include "roadnet/paths/path_frame.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace roadbook {
namespace {

constexpr double kTolerance_m = 1e-9;
constexpr double kSamePlace_m = 1e-6;  // feet found from both sides of a joint are one
constexpr int kNearSteps = 12;

PathProjection outside(ProjectionStatus status) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  return {status, kNone, kNone};
}

// (g - p) . g': zero at a foot point, growing through it where the point is on this side of the
// centre of curvature.
double slope(const PathPiece::Derivatives& d, const Eigen::Vector2d& p) {
  return (d.x - p.x()) * d.dx + (d.y - p.y()) * d.dy;
}

double slope_change(const PathPiece::Derivatives& d, const Eigen::Vector2d& p) {
  return d.dx * d.dx + d.dy * d.dy + (d.x - p.x()) * d.ddx + (d.y - p.y()) * d.ddy;
}

}  // namespace

const char* to_text(ProjectionStatus status) {
  switch (status) {
    case ProjectionStatus::kInside:
      return "inside";
    case ProjectionStatus::kOutsideTube:
      return "outside the tube";
    case ProjectionStatus::kBeforeStart:
      return "before the start";
    case ProjectionStatus::kBeyondEnd:
      return "beyond the end";
    case ProjectionStatus::kNotUnique:
      return "not unique";
  }
  return "";
}

PathFrame::PathFrame(PathCurve curve, const Tube& tube)
    : curve_(std::move(curve)), tube_(tube), check_(check_tube(curve_, tube_)) {
  cut_arcs();
  register_arcs();
}

bool PathFrame::in_tube(double e_m) const {
  return e_m >= tube_.e_min_m - kTolerance_m && e_m <= tube_.e_max_m + kTolerance_m;
}

PathFrame::Foot PathFrame::make_foot(std::size_t piece, double v, const Eigen::Vector2d& p) const {
  const PathPiece& at = curve_.pieces()[piece];
  const auto d = at.at(v);
  const double speed = std::sqrt(d.dx * d.dx + d.dy * d.dy);
  const double e = (d.dx * (p.y() - d.y) - d.dy * (p.x() - d.x)) / speed;
  return {piece, v, at.s_begin_m + at.arc_at(v), e, slope_change(d, p) <= 0.0};
}

// Newton's method from the cursor, from piece to piece. Gives up where the point is beyond the
// centre of curvature, at an open end, and when it takes long.
std::optional<PathFrame::Foot> PathFrame::near_foot(const Eigen::Vector2d& p,
                                                    PathCursor cursor) const {
  const auto& pieces = curve_.pieces();
  std::size_t piece = cursor.piece < pieces.size() ? cursor.piece : 0;
  double v = std::clamp(cursor.v, -1.0, 1.0);
  for (int i = 0; i < kNearSteps; ++i) {
    const auto d = pieces[piece].at(v);
    const double change = slope_change(d, p);
    if (!(change > 0.0)) return std::nullopt;
    const double step = slope(d, p) / change;
    v -= step;
    if (std::abs(v) <= 1.0) {
      // The remainder after a step is of the order of its square.
      if (std::abs(step) * pieces[piece].length_m < 1e-6) return make_foot(piece, v, p);
      continue;
    }
    const bool onward = v > 0.0;
    const bool last = piece == (onward ? pieces.size() - 1 : 0);
    if (last && !curve_.closed()) return std::nullopt;
    const double beyond =
        std::min(0.5 * (std::abs(v) - 1.0) * pieces[piece].length_m, pieces[piece].length_m);
    piece = onward ? (last ? 0 : piece + 1) : (last ? pieces.size() - 1 : piece - 1);
    const double into = std::min(2.0 * beyond / pieces[piece].length_m, 2.0);
    v = onward ? -1.0 + into : 1.0 - into;
  }
  return std::nullopt;
}

// The foot point on an arc, where the slope changes its sign there; bisection guards Newton's
// method.
std::optional<PathFrame::Foot> PathFrame::foot_on(const Arc& arc, const Eigen::Vector2d& p) const {
  const double at_begin = slope(arc.begin, p);
  const double at_end = slope(arc.end, p);
  const PathPiece& piece = curve_.pieces()[arc.piece];
  const double speed = 0.5 * piece.length_m;
  if (at_begin * at_end > 0.0) {
    if (curve_.closed()) return std::nullopt;
    // Rounding may make a point straight at the side of an open end miss it.
    const bool first = &arc == &arcs_.front();
    const bool last = &arc == &arcs_.back();
    if (first && std::abs(at_begin) <= kTolerance_m * speed) return make_foot(arc.piece, -1.0, p);
    if (last && std::abs(at_end) <= kTolerance_m * speed) return make_foot(arc.piece, 1.0, p);
    return std::nullopt;
  }
  double low = arc.v_begin;
  double high = arc.v_end;
  const bool rising = at_begin < at_end;
  double v = 0.5 * (low + high);
  for (int i = 0; i < 60; ++i) {
    const auto d = piece.at(v);
    const double f = slope(d, p);
    ((f < 0.0) == rising ? low : high) = v;
    double next = v - f / slope_change(d, p);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const double step = std::abs(next - v);
    v = next;
    if (step * speed < 1e-11) break;
  }
  return make_foot(arc.piece, v, p);
}

PathProjection PathFrame::search(const Eigen::Vector2d& p, PathCursor& cursor) const {
  const auto cell = cells_.find(cell_of(p.x(), p.y()));
  if (cell == cells_.end()) return outside(why_outside(p));
  std::optional<Foot> found;
  for (const int index : cell->second) {
    const auto foot = foot_on(arcs_[static_cast<std::size_t>(index)], p);
    if (!foot || !in_tube(foot->e_m)) continue;
    if (foot->folded) return outside(ProjectionStatus::kNotUnique);
    if (found && curve_.distance_along(found->s_m, foot->s_m) > kSamePlace_m)
      return outside(ProjectionStatus::kNotUnique);
    if (!found) found = foot;
  }
  if (!found) return outside(why_outside(p));
  cursor = {found->piece, found->v};
  const double s =
      curve_.closed() ? curve_.wrapped(found->s_m) : std::clamp(found->s_m, 0.0, curve_.length_m());
  return {ProjectionStatus::kInside, s, found->e_m};
}

PathProjection PathFrame::project(const Eigen::Vector2d& p, PathCursor& cursor) const {
  if (!p.allFinite()) return outside(ProjectionStatus::kOutsideTube);
  const auto foot = near_foot(p, cursor);
  if (foot && in_tube(foot->e_m) && check_.safe_piece[foot->piece]) {
    cursor = {foot->piece, foot->v};
    return {ProjectionStatus::kInside, curve_.closed() ? curve_.wrapped(foot->s_m) : foot->s_m,
            foot->e_m};
  }
  return search(p, cursor);
}

PathProjection PathFrame::project(const Eigen::Vector2d& p) const {
  PathCursor cursor;
  if (!p.allFinite()) return outside(ProjectionStatus::kOutsideTube);
  return search(p, cursor);
}

std::optional<Eigen::Vector2d> PathFrame::position(double s_m, double e_m) const {
  if (!std::isfinite(s_m) || !in_tube(e_m)) return std::nullopt;
  if (!curve_.closed() && (s_m < -kTolerance_m || s_m > curve_.length_m() + kTolerance_m))
    return std::nullopt;
  const PathPoint at = curve_.at(s_m);
  return Eigen::Vector2d(at.position + e_m * at.left());
}

}  // namespace roadbook
