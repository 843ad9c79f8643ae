#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/random.hpp"
#include "roadnet/network.hpp"

namespace roadbook::test {

/// A ring road: a rectangle [0, width] x [0, height] whose corners are arcs, driven
/// counter-clockwise.
struct RoundedRectangle {
  double width = 60.0;
  double height = 35.0;
  double radius = 5.5;

  [[nodiscard]] double length() const {
    return 2.0 * (width + height) - (8.0 - 2.0 * std::numbers::pi) * radius;
  }
  /// Signed distance from the line, positive outside.
  [[nodiscard]] double distance(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d q =
        (p - Eigen::Vector2d(width, height) / 2.0).cwiseAbs() -
        (Eigen::Vector2d(width, height) / 2.0 - Eigen::Vector2d::Constant(radius));
    return q.cwiseMax(0.0).norm() + std::min(std::max(q.x(), q.y()), 0.0) - radius;
  }
  /// The point at s, `offset` to the left, from the middle of the lower side.
  [[nodiscard]] Eigen::Vector3d at(double s, double offset) const {
    const double sides[] = {width - 2 * radius, height - 2 * radius, width - 2 * radius,
                            height - 2 * radius};
    const double arc = 0.5 * std::numbers::pi * radius;
    Eigen::Vector2d p(width / 2, 0.0);
    double heading = 0.0;
    double rest = s - length() * std::floor(s / length()) + sides[0] / 2;
    p.x() -= sides[0] / 2;
    for (int side = 0;; side = (side + 1) % 4) {
      const Eigen::Vector2d ahead(std::cos(heading), std::sin(heading));
      const Eigen::Vector2d left(-ahead.y(), ahead.x());
      if (rest <= sides[side]) {
        p += rest * ahead + offset * left;
        break;
      }
      p += sides[side] * ahead;
      rest -= sides[side];
      if (rest <= arc) {
        const double a = rest / radius;
        p += radius * left + (radius - offset) * (std::sin(a) * ahead - std::cos(a) * left);
        break;
      }
      p += radius * (ahead + left);
      rest -= arc;
      heading += 0.5 * std::numbers::pi;
    }
    return {p.x(), p.y(), 0.0};
  }
};

/// One pass of several laps, 0.2 m between positions, with a lateral offset that changes slowly.
inline std::vector<DrivenPass> drive_round(const RoundedRectangle& road,
                                           int laps,
                                           double scatter_m,
                                           std::uint64_t seed) {
  Random random(seed, "drive round");
  DrivenPass pass;
  double offset = random.normal(0.0, scatter_m);
  const double keep = std::exp(-0.2 / 30.0);  // correlated over 30 m
  for (double s = 0.0; s < laps * road.length(); s += 0.2) {
    pass.positions.push_back(road.at(s, offset));
    offset = keep * offset + std::sqrt(1.0 - keep * keep) * random.normal(0.0, scatter_m);
  }
  return {pass};
}

}  // namespace roadbook::test
