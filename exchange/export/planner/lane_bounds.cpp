#include "exchange/export/planner/lane_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace roadbook {
namespace {

constexpr double kDense_m = 0.1;
constexpr double kMostOfRadius = 0.9;  // of a bend, that its inner bound lies inside the curve
constexpr int kMostRounds = 4000;

// Of the circle through three points (Menger).
double curvature_of(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const Eigen::Vector2d u = b - a;
  const Eigen::Vector2d v = c - a;
  const double twice_area = std::abs(u.x() * v.y() - u.y() * v.x());
  const double product = u.norm() * v.norm() * (c - b).norm();
  return product > 1e-12 ? 2.0 * twice_area / product : 0.0;
}

// Moves points of too tight bends towards the chord of their neighbours until none is left. The
// ends stay.
void ease(std::vector<Eigen::Vector3d>& line) {
  constexpr double kAim = 0.98 * kMostBoundCurvature;
  bool moved = true;
  for (int round = 0; moved && round < kMostRounds; ++round) {
    moved = false;
    for (std::size_t i = 1; i + 1 < line.size(); ++i) {
      const Eigen::Vector2d a = line[i - 1].head<2>();
      const Eigen::Vector2d b = line[i].head<2>();
      const Eigen::Vector2d c = line[i + 1].head<2>();
      if (curvature_of(a, b, c) <= kMostBoundCurvature) continue;
      const Eigen::Vector2d middle = 0.5 * (a + c);
      const double bow = (b - middle).norm();
      const double allowed = 0.125 * kAim * (c - a).squaredNorm();
      line[i].head<2>() = middle + (b - middle) * std::min(0.5, allowed / bow);
      moved = true;
    }
  }
}

LaneBounds bounds_beside(const PathCurve& curve,
                         double begin_m,
                         double end_m,
                         const std::function<double(double share)>& half_width) {
  LaneBounds bounds;
  const int steps = std::max(2, static_cast<int>(std::ceil((end_m - begin_m) / kDense_m)));
  for (int i = 0; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    const double s = i == steps ? end_m : begin_m + share * (end_m - begin_m);
    const PathPoint p = curve.at(s);
    const double half = half_width(share);
    const double inside = kMostOfRadius / std::max(std::abs(p.curvature), 1e-9);
    const double left = p.curvature > 0.0 ? std::min(half, inside) : half;
    const double right = p.curvature < 0.0 ? std::min(half, inside) : half;
    const Eigen::Vector2d l = p.position + left * p.left();
    const Eigen::Vector2d r = p.position - right * p.left();
    bounds.s_m.push_back(s);
    bounds.left.emplace_back(l.x(), l.y(), p.height_m);
    bounds.right.emplace_back(r.x(), r.y(), p.height_m);
  }
  ease(bounds.left);
  ease(bounds.right);
  return bounds;
}

double width_at(const LaneLayout& layout, const PieceEnd& end) {
  return layout.pieces[static_cast<std::size_t>(end.piece)].width_m;
}

}  // namespace

LaneBounds LaneBounds::part(double begin_m, double end_m) const {
  LaneBounds cut;
  const auto add = [&](double s, const Eigen::Vector3d& l, const Eigen::Vector3d& r) {
    cut.s_m.push_back(s);
    cut.left.push_back(l);
    cut.right.push_back(r);
  };
  const auto add_between = [&](double s) {
    const auto above = std::lower_bound(s_m.begin() + 1, s_m.end() - 1, s);
    const auto j = static_cast<std::size_t>(above - s_m.begin());
    const double share = (s - s_m[j - 1]) / (s_m[j] - s_m[j - 1]);
    add(s, left[j - 1] + share * (left[j] - left[j - 1]),
        right[j - 1] + share * (right[j] - right[j - 1]));
  };
  add_between(begin_m);
  const double near = 0.2 * std::min(kDense_m, end_m - begin_m);
  for (std::size_t i = 0; i < s_m.size(); ++i)
    if (s_m[i] > begin_m + near && s_m[i] < end_m - near) add(s_m[i], left[i], right[i]);
  add_between(end_m);
  return cut;
}

double LaneBounds::centre_length_m() const {
  double length = 0.0;
  for (std::size_t i = 1; i < s_m.size(); ++i)
    length += 0.5 * (left[i] + right[i] - left[i - 1] - right[i - 1]).head<2>().norm();
  return length;
}

LaneBounds bounds_of(const LanePiece& piece) {
  return bounds_beside(piece.curve, piece.s_begin_m, piece.s_end_m,
                       [&](double) { return 0.5 * piece.width_m; });
}

LaneBounds bounds_of(const Connector& turn, const LaneLayout& layout) {
  const double from = 0.5 * width_at(layout, turn.from);
  const double to = 0.5 * width_at(layout, turn.to);
  return bounds_beside(turn.curve, 0.0, turn.curve.length_m(), [&](double share) {
    return from + (to - from) * share * share * (3.0 - 2.0 * share);
  });
}

bool chord_fits(const std::vector<Eigen::Vector3d>& line, std::size_t from, std::size_t to) {
  constexpr double kSagitta_m = 0.003;
  constexpr double kLongest_m = 2.0;
  const Eigen::Vector2d a = line[from].head<2>();
  const Eigen::Vector2d chord = line[to].head<2>() - a;
  if (chord.norm() > kLongest_m) return false;
  const Eigen::Vector2d along = chord.normalized();
  for (std::size_t i = from + 1; i < to; ++i) {
    const Eigen::Vector2d p = line[i].head<2>() - a;
    if (std::abs(along.x() * p.y() - along.y() * p.x()) > kSagitta_m) return false;
  }
  return true;
}

double largest_curvature(const std::vector<Eigen::Vector3d>& line) {
  double largest = 0.0;
  for (std::size_t i = 1; i + 1 < line.size(); ++i)
    largest = std::max(
        largest, curvature_of(line[i - 1].head<2>(), line[i].head<2>(), line[i + 1].head<2>()));
  return largest;
}

}  // namespace roadbook
