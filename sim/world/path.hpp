#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sim/scenario/scenario.hpp"

namespace roadbook {

/// A smooth driving line: straights and arcs, sampled by arc length.
class DrivingLine {
 public:
  /// Rounds the corners of `corners` to `radius_m` (less where the legs are too short). A closed
  /// line comes back to its first point. Throws std::invalid_argument for fewer than two points.
  DrivingLine(const std::vector<Eigen::Vector2d>& corners, double radius_m, bool closed);

  [[nodiscard]] double length_m() const { return length_m_; }
  [[nodiscard]] bool closed() const { return closed_; }
  /// Point at s; beyond the ends straight on, or round again if closed.
  [[nodiscard]] Eigen::Vector2d at(double s) const;
  [[nodiscard]] double heading(double s) const;
  /// Signed curvature [1/m], positive to the left.
  [[nodiscard]] double curvature(double s) const;
  /// s of the point nearest to `p`, searched within `window_m` of `near_s`.
  [[nodiscard]] double nearest(const Eigen::Vector2d& p, double near_s, double window_m) const;
  /// Points about every `step_m`, first and last included.
  [[nodiscard]] std::vector<Eigen::Vector2d> sampled(double step_m) const;

 private:
  void add(const Eigen::Vector2d& point);
  [[nodiscard]] double wrapped(double s) const;

  std::vector<Eigen::Vector2d> points_;  ///< every few centimetres
  double step_m_ = 0.05;
  double length_m_ = 0.0;
  bool closed_ = false;
};

/// The line along the named lanes, one after the other; closed if the last leads back to the first.
[[nodiscard]] DrivingLine route_line(const Scenario& scenario,
                                     const std::vector<std::string>& lanes);

}  // namespace roadbook
