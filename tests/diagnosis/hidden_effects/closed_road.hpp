#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/random.hpp"

namespace roadbook::test {

inline constexpr double kTwoPi = 2.0 * std::numbers::pi;

struct Point {
  double x, y;
};

// A closed road of 500 to 900 m as a table of its points, evenly spaced.
class ClosedRoad {
 public:
  explicit ClosedRoad(Random random) {
    std::array<double, 4> size{}, phase{};
    for (std::size_t k = 0; k < size.size(); ++k) {
      size[k] = random.uniform(0.05, 0.2) / static_cast<double>(k + 1);
      phase[k] = random.uniform(0.0, kTwoPi);
    }
    const double radius = random.uniform(75.0, 130.0);
    std::vector<Point> fine;
    for (int i = 0; i <= 20000; ++i) {
      const double a = kTwoPi * i / 20000.0;
      double r = radius;
      for (std::size_t k = 0; k < size.size(); ++k)
        r += radius * size[k] * std::cos(static_cast<double>(k + 2) * a + phase[k]);
      fine.push_back({r * std::cos(a), r * std::sin(a)});
    }
    double along = 0.0;
    points_.push_back(fine.front());
    for (std::size_t i = 1; i < fine.size(); ++i) {
      along += std::hypot(fine[i].x - fine[i - 1].x, fine[i].y - fine[i - 1].y);
      if (along >= kStep * static_cast<double>(points_.size())) points_.push_back(fine[i]);
    }
    length_ = kStep * static_cast<double>(points_.size());
  }
  [[nodiscard]] double length() const { return length_; }
  [[nodiscard]] Point at(double s) const {
    const double u = std::fmod(s, length_) / kStep;
    const auto i = static_cast<std::size_t>(u) % points_.size();
    const Point& a = points_[i];
    const Point& b = points_[(i + 1) % points_.size()];
    const double f = u - std::floor(u);
    return {a.x + f * (b.x - a.x), a.y + f * (b.y - a.y)};
  }
  [[nodiscard]] double heading(double s) const {
    const Point a = at(s + length_ - 1.0);
    const Point b = at(s + 1.0);
    return std::atan2(b.y - a.y, b.x - a.x);
  }

 private:
  static constexpr double kStep = 0.25;
  std::vector<Point> points_;
  double length_ = 0.0;
};

}  // namespace roadbook::test
