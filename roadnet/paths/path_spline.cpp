#include "roadnet/paths/path_spline.hpp"

#include <algorithm>

namespace roadbook {
namespace {

// The `degree` knots on one side of segment i, in units of a segment from its start: a joint counts
// degree - 2 times, the end of an open path as often as wanted.
std::vector<double> knots_beside(int degree, int segments, bool closed, int i, bool right) {
  std::vector<double> knots;
  const int multiplicity = degree - 2;
  for (int step = 0; static_cast<int>(knots.size()) < degree; ++step) {
    const int joint = right ? i + 1 + step : i - step;
    const bool end = !closed && (joint == 0 || joint == segments);
    const int count = end ? degree : multiplicity;
    for (int k = 0; k < count && static_cast<int>(knots.size()) < degree; ++k)
      knots.push_back(static_cast<double>(joint - i));
  }
  if (!right) std::reverse(knots.begin(), knots.end());
  return knots;
}

}  // namespace

Eigen::MatrixXd bezier_extraction(const std::vector<double>& left,
                                  const std::vector<double>& right) {
  const int n = static_cast<int>(left.size());
  std::vector<double> u = left;
  u.insert(u.end(), right.begin(), right.end());
  const auto knot = [&u](int k) { return u[static_cast<std::size_t>(k - 1)]; };  // u_1 .. u_2n
  Eigen::MatrixXd control(n + 1, n + 1);
  for (int j = 0; j <= n; ++j) {
    // Blossom value at (0, .., 0, 1, .., 1) with j ones: de Boor's recursion, one argument a level.
    Eigen::MatrixXd d = Eigen::MatrixXd::Identity(n + 1, n + 1);
    for (int r = 1; r <= n; ++r) {
      const double x = r <= n - j ? 0.0 : 1.0;
      for (int k = 0; k <= n - r; ++k) {
        const double a = knot(k + r);
        const double b = knot(k + n + 1);
        d.row(k) = ((b - x) * d.row(k) + (x - a) * d.row(k + 1)) / (b - a);
      }
    }
    control.row(j) = d.row(0);
  }
  return control;
}

PathSpline::PathSpline(int degree, int segments, bool closed)
    : degree_(degree), unknowns_(closed ? (degree - 2) * segments : (degree - 2) * segments + 3) {
  for (int i = 0; i < segments; ++i) {
    // Segments far from the ends all look the same.
    const bool same = i > degree && (closed || i + degree < segments);
    extraction_.push_back(same
                              ? extraction_.back()
                              : bezier_extraction(knots_beside(degree, segments, closed, i, false),
                                                  knots_beside(degree, segments, closed, i, true)));
  }
}

}  // namespace roadbook
