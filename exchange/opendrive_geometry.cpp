#include "exchange/opendrive_geometry.hpp"

#include <cmath>

namespace roadbook {
namespace {

constexpr double kShortest_m = 0.05;

// The cubic from value and slope at both ends.
void hermite(double a, double slope_a, double b, double slope_b, double length, double* c) {
  const double d = (b - a) / length;
  c[0] = a;
  c[1] = slope_a;
  c[2] = (3.0 * d - 2.0 * slope_a - slope_b) / length;
  c[3] = (slope_a + slope_b - 2.0 * d) / (length * length);
}

double height_slope(const PathCurve& curve, double s, double begin_m, double end_m) {
  const double h = 1e-3;
  const double a = std::max(begin_m, s - h);
  const double b = std::min(end_m, s + h);
  return (curve.at(b).height_m - curve.at(a).height_m) / (b - a);
}

DriveCubic cubic(const PathCurve& curve, double begin_m, double a_m, double b_m, double end_m) {
  const PathPoint a = curve.at(a_m);
  // The end of a ring is its begin: what is just before it stands for it.
  const PathPoint b = curve.at(b_m);
  DriveCubic c;
  c.s_m = a_m - begin_m;
  c.x = a.position.x();
  c.y = a.position.y();
  c.heading = a.heading();
  c.length_m = b_m - a_m;
  const Eigen::Vector2d chord = b.position - a.position;
  hermite(0.0, 1.0, a.tangent.dot(chord), a.tangent.dot(b.tangent), c.length_m, c.u);
  hermite(0.0, 0.0, a.left().dot(chord), a.left().dot(b.tangent), c.length_m, c.v);
  hermite(a.height_m, height_slope(curve, a_m, begin_m, end_m), b.height_m,
          height_slope(curve, b_m, begin_m, end_m), c.length_m, c.z);
  return c;
}

void add(const PathCurve& curve,
         double begin_m,
         double a_m,
         double b_m,
         double end_m,
         double tolerance_m,
         std::vector<DriveCubic>& cubics) {
  const DriveCubic c = cubic(curve, begin_m, a_m, b_m, end_m);
  double worst = 0.0;
  for (int i = 1; i < 8; ++i) {
    const double p = c.length_m * i / 8.0;
    worst = std::max(worst, (c.at(p) - curve.at(a_m + p).position).norm());
  }
  if (worst <= tolerance_m || c.length_m < kShortest_m) {
    cubics.push_back(c);
    return;
  }
  const double middle = 0.5 * (a_m + b_m);
  add(curve, begin_m, a_m, middle, end_m, tolerance_m, cubics);
  add(curve, begin_m, middle, b_m, end_m, tolerance_m, cubics);
}

}  // namespace

Eigen::Vector2d DriveCubic::at(double p_m) const {
  const auto value = [p_m](const double* c) {
    return c[0] + p_m * (c[1] + p_m * (c[2] + p_m * c[3]));
  };
  const double du = value(u);
  const double dv = value(v);
  return {x + du * std::cos(heading) - dv * std::sin(heading),
          y + du * std::sin(heading) + dv * std::cos(heading)};
}

std::vector<DriveCubic> drive_cubics(const PathCurve& curve,
                                     double begin_m,
                                     double end_m,
                                     double tolerance_m) {
  std::vector<DriveCubic> cubics;
  // Pieces to begin with are short: eight samples must not miss a bend.
  const int parts = std::max(1, static_cast<int>(std::ceil((end_m - begin_m) / 10.0)));
  for (int i = 0; i < parts; ++i)
    add(curve, begin_m, begin_m + (end_m - begin_m) * i / parts,
        begin_m + (end_m - begin_m) * (i + 1) / parts, end_m, tolerance_m, cubics);
  return cubics;
}

}  // namespace roadbook
