#include "roadnet/paths/path_piece.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "base/error.hpp"

namespace roadbook {
namespace {

constexpr int kNodes = 18;            // Chebyshev nodes of the speed
constexpr double kRounding = 1e-15;   // of the arc length, relative
constexpr double kMostTurn = 0.5;     // [rad] from the middle of a piece to its ends
constexpr double kStandstill = 1e-6;  // of the mean speed
constexpr int kDeepest = 14;          // halvings of a quarter segment

// Powers of v of the polynomial with these control points, restricted to [u0, u1]. Blossoming at
// u0 and u1 gives the control points of the part; the change to powers is exact but for rounding.
void to_powers(const Eigen::Vector3d* control, int n, double u0, double u1, PathPiece& piece) {
  const double mid = 0.5 * (u0 + u1);
  const double half = 0.5 * (u1 - u0);
  // Derivatives at the middle: differences of control points, evaluated there.
  std::array<Eigen::Vector3d, kMaxPathDegree + 1> d;
  std::copy(control, control + n + 1, d.begin());
  double factor = 1.0;
  for (int k = 0; k <= n; ++k) {
    double weights[kMaxPathDegree + 1];
    bernstein(n - k, mid, weights);
    Eigen::Vector3d value = Eigen::Vector3d::Zero();
    for (int j = 0; j <= n - k; ++j) value += weights[j] * d[static_cast<std::size_t>(j)];
    const auto i = static_cast<std::size_t>(k);
    piece.x[i] = factor * value.x();
    piece.y[i] = factor * value.y();
    piece.z[i] = factor * value.z();
    for (int j = 0; j < n - k; ++j)
      d[static_cast<std::size_t>(j)] =
          d[static_cast<std::size_t>(j + 1)] - d[static_cast<std::size_t>(j)];
    factor *= half * (n - k) / (k + 1);
  }
}

// Arc length as a Chebyshev series, from the speed at Chebyshev nodes. Returns whether the series
// ends at rounding.
bool measure_arc(PathPiece& piece, double& slowest) {
  for (const double v : {-1.0, 1.0}) {
    const auto d = piece.at(v);
    slowest = std::min(slowest, std::hypot(d.dx, d.dy));
  }
  std::array<double, kNodes> speed{};
  for (int j = 0; j < kNodes; ++j) {
    const auto d = piece.at(std::cos(std::numbers::pi * (j + 0.5) / kNodes));
    speed[static_cast<std::size_t>(j)] = std::hypot(d.dx, d.dy);
    slowest = std::min(slowest, speed[static_cast<std::size_t>(j)]);
  }
  std::array<double, kNodes + 2> c{};
  for (int k = 0; k < kNodes; ++k) {
    double sum = 0.0;
    for (int j = 0; j < kNodes; ++j)
      sum +=
          speed[static_cast<std::size_t>(j)] * std::cos(std::numbers::pi * k * (j + 0.5) / kNodes);
    c[static_cast<std::size_t>(k)] = (k == 0 ? 1.0 : 2.0) / kNodes * sum;
  }
  double at_begin = 0.0;
  piece.arc_terms = 1;
  for (int k = 1; k <= kNodes; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const double below = k == 1 ? 2.0 * c[0] : c[i - 1];
    piece.arc[i] = (below - c[i + 1]) / (2.0 * k);
    at_begin += (k % 2 == 0 ? 1.0 : -1.0) * piece.arc[i];
    if (std::abs(piece.arc[i]) > kRounding * c[0]) piece.arc_terms = k + 1;
  }
  piece.arc[0] = -at_begin;
  piece.length_m = piece.arc_at(1.0);
  return piece.arc_terms <= kNodes - 2;
}

bool turns_little(const PathPiece& piece) {
  const auto turn = [](const PathPiece::Derivatives& a, const PathPiece::Derivatives& b) {
    return std::abs(std::atan2(a.dx * b.dy - a.dy * b.dx, a.dx * b.dx + a.dy * b.dy));
  };
  const auto middle = piece.at(0.0);
  return turn(middle, piece.at(-1.0)) < kMostTurn && turn(middle, piece.at(1.0)) < kMostTurn;
}

void cut(const BezierPath& path,
         int segment,
         double u0,
         double u1,
         int depth,
         std::vector<PathPiece>& pieces) {
  PathPiece piece;
  piece.degree = path.degree;
  to_powers(path.segment(segment), path.degree, u0, u1, piece);
  double slowest = std::numeric_limits<double>::max();
  const bool measured = measure_arc(piece, slowest);
  if (measured && turns_little(piece) && slowest > kStandstill * piece.length_m) {
    piece.s_begin_m = pieces.empty() ? 0.0 : pieces.back().s_begin_m + pieces.back().length_m;
    pieces.push_back(piece);
    return;
  }
  if (depth == kDeepest)
    throw BadInput(Problem{
        Severity::kError, "", 0,
        "path near (" + std::to_string(piece.x[0]) + ", " + std::to_string(piece.y[0]) + ")",
        "a cusp: the curve stands still", "a curve that goes on"});
  const double mid = 0.5 * (u0 + u1);
  cut(path, segment, u0, mid, depth + 1, pieces);
  cut(path, segment, mid, u1, depth + 1, pieces);
}

}  // namespace

double PathPiece::v_at(double arc_m) const {
  double v = std::clamp(2.0 * arc_m / length_m - 1.0, -1.0, 1.0);
  for (int i = 0; i < 20; ++i) {
    const auto d = at(v);
    const double step = (arc_at(v) - arc_m) / std::sqrt(d.dx * d.dx + d.dy * d.dy);
    v = std::clamp(v - step, -1.0, 1.0);
    if (std::abs(step) < 1e-8) break;  // the step after this one would be below rounding
  }
  return v;
}

std::vector<PathPiece> cut_into_pieces(const BezierPath& path) {
  path.check();
  std::vector<PathPiece> pieces;
  for (int i = 0; i < path.segments(); ++i)
    for (int quarter = 0; quarter < 4; ++quarter)
      cut(path, i, 0.25 * quarter, 0.25 * (quarter + 1), 0, pieces);
  return pieces;
}

}  // namespace roadbook
