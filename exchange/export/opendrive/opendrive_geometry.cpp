#include "exchange/export/opendrive/opendrive_geometry.hpp"

#include <algorithm>
#include <cmath>

namespace roadbook {
namespace {

constexpr double kFirstChord_m = 0.3;  // of a bent end
constexpr double kBentEnd = 0.05;      // [1/m]

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
  // The end of a ring is its begin: the point just before it is used.
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

// Largest distance of the curve from the chord between two of its places.
double sagitta(const PathCurve& curve, double a_m, double b_m) {
  const Eigen::Vector2d a = curve.at(a_m).position;
  const Eigen::Vector2d chord = curve.at(b_m).position - a;
  const Eigen::Vector2d left = Eigen::Vector2d(-chord.y(), chord.x()).normalized();
  double worst = 0.0;
  for (int i = 1; i < 8; ++i)
    worst = std::max(worst, std::abs(left.dot(curve.at(a_m + (b_m - a_m) * i / 8.0).position - a)));
  return worst;
}

// Ends of the cubics over a stretch, its begin left out.
void divide(const PathCurve& curve,
            double a_m,
            double b_m,
            const DriveCubicOptions& options,
            std::vector<double>& ends) {
  if (b_m - a_m < 2.0 * options.shortest_m || sagitta(curve, a_m, b_m) <= options.sagitta_m) {
    ends.push_back(b_m);
    return;
  }
  const double middle = 0.5 * (a_m + b_m);
  divide(curve, a_m, middle, options, ends);
  divide(curve, middle, b_m, options, ends);
}

void divide_evenly(const PathCurve& curve,
                   double a_m,
                   double b_m,
                   const DriveCubicOptions& options,
                   std::vector<double>& ends) {
  if (!(b_m - a_m > 1e-9)) return;
  const int parts = std::max(1, static_cast<int>(std::ceil((b_m - a_m) / options.longest_m)));
  for (int i = 0; i < parts; ++i)
    divide(curve, a_m + (b_m - a_m) * i / parts, a_m + (b_m - a_m) * (i + 1) / parts, options,
           ends);
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

double bent_end_m(const PathCurve& curve, double at_m, double length_m) {
  const double zone = kFirstChord_m + DriveCubicOptions{}.shortest_m;
  const bool bent = std::abs(curve.at(at_m).curvature) > kBentEnd;
  return bent && length_m >= 3.0 * zone ? zone : 0.0;
}

std::vector<DriveCubic> drive_cubics(const PathCurve& curve,
                                     double begin_m,
                                     double end_m,
                                     const std::vector<DriveStretch>& fixed,
                                     const DriveCubicOptions& options) {
  const double first = bent_end_m(curve, begin_m, end_m - begin_m);
  const double last = bent_end_m(curve, end_m, end_m - begin_m);
  std::vector<double> ends{begin_m};
  if (first > 0.0) ends.insert(ends.end(), {begin_m + kFirstChord_m, begin_m + first});
  for (const DriveStretch& stretch : fixed) {
    divide_evenly(curve, ends.back(), stretch.begin_m, options, ends);
    ends.push_back(stretch.end_m);
  }
  divide_evenly(curve, ends.back(), end_m - last, options, ends);
  if (last > 0.0) ends.insert(ends.end(), {end_m - kFirstChord_m, end_m});
  std::vector<DriveCubic> cubics;
  for (std::size_t i = 1; i < ends.size(); ++i)
    cubics.push_back(cubic(curve, begin_m, ends[i - 1], ends[i], end_m));
  return cubics;
}

}  // namespace roadbook
