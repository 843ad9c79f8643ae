#pragma once

#include <Eigen/Core>
#include <vector>

namespace roadbook {

/// The B-splines of one degree with two continuous derivatives over equal intervals, converted to
/// Bezier form on each interval.
class PathSpline {
 public:
  PathSpline(int degree, int segments, bool closed);

  [[nodiscard]] int unknowns() const { return unknowns_; }
  /// Index of the k-th coefficient that acts on a segment, k in 0..degree.
  [[nodiscard]] int unknown(int segment, int k) const {
    return ((degree_ - 2) * segment + k) % unknowns_;
  }
  /// Extraction matrix of a segment: control points = matrix * coefficients that act on it.
  [[nodiscard]] const Eigen::MatrixXd& extraction(int segment) const {
    return extraction_[static_cast<std::size_t>(segment)];
  }

 private:
  int degree_;
  int unknowns_;
  std::vector<Eigen::MatrixXd> extraction_;
};

/// Extraction of a segment [0, 1] whose `degree` knots to the left (last: 0) and to the right
/// (first: 1) are given, ascending.
[[nodiscard]] Eigen::MatrixXd bezier_extraction(const std::vector<double>& left,
                                                const std::vector<double>& right);

}  // namespace roadbook
