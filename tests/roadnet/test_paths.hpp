#pragma once

#include <Eigen/Core>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "base/text.hpp"
#include "roadnet/paths/path_fit.hpp"

namespace roadbook::test {

/// The two-mile road of the golden values' notes: its heading is three sinusoids of arc length, so
/// that curvature and arc length are known exactly; positions by Simpson's rule on millimetres.
class TwoMileRoad {
 public:
  static constexpr double kLength = 3218.7;

  static double heading(double s) {
    constexpr double kTurn = 2.0 * std::numbers::pi;
    return 1.0 * std::sin(kTurn * s / 1100.0) + 0.5 * std::sin(kTurn * s / 420.0) +
           0.12 * std::sin(kTurn * s / 150.0);
  }
  static double curvature(double s) {
    constexpr double kTurn = 2.0 * std::numbers::pi;
    return kTurn *
           (1.0 / 1100.0 * std::cos(kTurn * s / 1100.0) +
            0.5 / 420.0 * std::cos(kTurn * s / 420.0) + 0.12 / 150.0 * std::cos(kTurn * s / 150.0));
  }
  /// Positions at 0, step, 2 step, ...
  static std::vector<Eigen::Vector3d> positions(int count) {
    const double step = kLength / (count - 1);
    const int parts = std::max(1, static_cast<int>(std::ceil(step / 0.25)));
    std::vector<Eigen::Vector3d> points{Eigen::Vector3d::Zero()};
    for (int i = 0; i + 1 < count; ++i) {
      Eigen::Vector3d p = points.back();
      const double h = step / parts;
      for (int k = 0; k < parts; ++k) {
        const double s = step * i + h * k;
        const auto d = [](double at) {
          return Eigen::Vector3d(std::cos(heading(at)), std::sin(heading(at)), 0.0);
        };
        p += h / 6.0 * (d(s) + 4.0 * d(s + 0.5 * h) + d(s + h));
      }
      points.push_back(p);
    }
    return points;
  }
};

/// A ring without symmetry: a circle with two waves.
inline Eigen::Vector3d ring_point(double angle) {
  const double r = 120.0 + 15.0 * std::cos(2.0 * angle) + 6.0 * std::sin(3.0 * angle);
  return {r * std::cos(angle), r * std::sin(angle), 0.0};
}

inline std::vector<Eigen::Vector3d> ring(int count) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) points.push_back(ring_point(2.0 * std::numbers::pi * i / count));
  return points;
}

/// A hairpin: two straights of 60 m, `2 radius` apart, joined by a half circle whose apex is at
/// (60 + radius, radius). One point every half metre.
inline std::vector<Eigen::Vector3d> hairpin(double radius) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 120; ++i) points.emplace_back(0.5 * i, 0.0, 0.0);
  const int steps = static_cast<int>(std::ceil(std::numbers::pi * radius / 0.25));
  for (int i = 0; i < steps; ++i) {
    const double a = -std::numbers::pi / 2 + std::numbers::pi * i / steps;
    points.emplace_back(60.0 + radius * std::cos(a), radius + radius * std::sin(a), 0.0);
  }
  for (int i = 120; i >= 0; --i) points.emplace_back(0.5 * i, 2.0 * radius, 0.0);
  return points;
}

/// Columns of a comma-separated file whose comment lines begin with '#'.
inline std::vector<std::vector<double>> read_csv(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::vector<double> row;
    for (const auto cell : split(line)) row.push_back(parse_double(cell).value());
    rows.push_back(row);
  }
  return rows;
}

inline constexpr const char* kTracks[] = {"BrandsHatch", "Hockenheim", "Norisring", "Nuerburgring",
                                          "Spielberg"};

/// Centre line of a race track of the real data.
inline std::vector<Eigen::Vector3d> track_centre(const std::filesystem::path& folder,
                                                 const std::string& name) {
  std::vector<Eigen::Vector3d> points;
  for (const auto& row : read_csv(folder / "tracks" / (name + ".csv")))
    points.emplace_back(row[0], row[1], 0.0);
  return points;
}

}  // namespace roadbook::test
