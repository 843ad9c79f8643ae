#include "roadnet/paths/bezier_path.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.hpp"

namespace roadbook {
namespace {

[[noreturn]] void bad_path(const std::string& field,
                           const std::string& got,
                           const std::string& want) {
  throw BadInput(Problem{Severity::kError, "", 0, "path " + field, got, want});
}

// Derivatives 0 to 2 with respect to the parameter at either end of a segment.
void end_derivatives(const BezierPath& path, int i, bool at_end, Eigen::Vector3d* d) {
  const Eigen::Vector3d* p = path.segment(i);
  const int n = path.degree;
  const auto k = static_cast<std::size_t>(i);
  const double h = path.knots[k + 1] - path.knots[k];
  const int a = at_end ? n : 0;
  const int step = at_end ? -1 : 1;
  d[0] = p[a];
  d[1] = n / h * step * (p[a + step] - p[a]);
  d[2] = n * (n - 1) / (h * h) * (p[a] - 2.0 * p[a + step] + p[a + 2 * step]);
}

}  // namespace

void BezierPath::check() const {
  if (degree < kMinPathDegree || degree > kMaxPathDegree)
    bad_path("degree", std::to_string(degree),
             std::to_string(kMinPathDegree) + " to " + std::to_string(kMaxPathDegree));
  if (segments() < 1) bad_path("knots", std::to_string(knots.size()), "two or more");
  const std::size_t wanted = static_cast<std::size_t>(segments() * (degree + 1));
  if (points.size() != wanted)
    bad_path("control points", std::to_string(points.size()), std::to_string(wanted));
  for (std::size_t i = 0; i + 1 < knots.size(); ++i)
    if (!(std::isfinite(knots[i]) && std::isfinite(knots[i + 1]) && knots[i] < knots[i + 1]))
      bad_path("knots", std::to_string(knots[i]) + " before " + std::to_string(knots[i + 1]),
               "finite, ascending values");
  for (const Eigen::Vector3d& p : points)
    if (!p.allFinite()) bad_path("control point", "a value that is not finite", "metres");
}

JointJumps joint_jumps(const BezierPath& path) {
  JointJumps jumps;
  const int M = path.segments();
  for (int i = path.closed ? 0 : 1; i < M; ++i) {
    Eigen::Vector3d before[3];
    Eigen::Vector3d after[3];
    end_derivatives(path, (i + M - 1) % M, true, before);
    end_derivatives(path, i, false, after);
    jumps.position_m = std::max(jumps.position_m, (after[0] - before[0]).norm());
    jumps.first = std::max(jumps.first, (after[1] - before[1]).norm());
    jumps.second = std::max(jumps.second, (after[2] - before[2]).norm());
  }
  return jumps;
}

void bernstein(int degree, double u, double* values) {
  values[0] = 1.0;
  for (int n = 1; n <= degree; ++n) {
    values[n] = u * values[n - 1];
    for (int k = n - 1; k > 0; --k) values[k] = (1.0 - u) * values[k] + u * values[k - 1];
    values[0] *= 1.0 - u;
  }
}

BezierPath reversed(const BezierPath& path) {
  BezierPath back = path;
  std::reverse(back.points.begin(), back.points.end());
  const double sum = path.knots.front() + path.knots.back();
  std::transform(path.knots.rbegin(), path.knots.rend(), back.knots.begin(),
                 [sum](double t) { return sum - t; });
  return back;
}

}  // namespace roadbook
