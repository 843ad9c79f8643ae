#pragma once

#include <Eigen/Core>
#include <vector>

namespace roadbook {

// A path as a chain of Bezier segments: the data that is fitted, stored and exchanged [SPM, section
// 3.1]. `PathCurve` is the same path prepared for queries.

constexpr int kMinPathDegree = 3;  ///< a lower degree has no continuous curvature at the joints
constexpr int kMaxPathDegree = 9;

struct BezierPath {
  int degree = 6;
  bool closed = false;
  /// Parameter values at the joints, ascending; one more than there are segments.
  std::vector<double> knots;
  /// degree + 1 control points for each segment [m, map], segment by segment. s and e do not depend
  /// on z.
  std::vector<Eigen::Vector3d> points;

  [[nodiscard]] int segments() const { return static_cast<int>(knots.size()) - 1; }
  [[nodiscard]] const Eigen::Vector3d* segment(int i) const {
    return &points[static_cast<std::size_t>(i) * static_cast<std::size_t>(degree + 1)];
  }

  /// Throws BadInput: degree, number of points, knots that do not ascend, values not finite.
  void check() const;
};

/// Largest differences between the two sides of a joint: position [m], first and second derivative
/// with respect to the parameter. A closed path has a joint where it closes.
struct JointJumps {
  double position_m = 0.0;
  double first = 0.0;
  double second = 0.0;
};
[[nodiscard]] JointJumps joint_jumps(const BezierPath& path);

/// Values of the Bernstein polynomials of `degree` at u in [0, 1]: degree + 1 numbers.
void bernstein(int degree, double u, double* values);

/// The same path driven the other way.
[[nodiscard]] BezierPath reversed(const BezierPath& path);

}  // namespace roadbook
