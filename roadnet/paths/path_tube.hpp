#pragma once

#include <string>
#include <vector>

#include "roadnet/paths/path_curve.hpp"

namespace roadbook {

// Conditions for unique path coordinates [SPM, lemma 1]. The tube of half width e_max around a path
// folds onto itself where the curvature reaches 1 / e_max. It overlaps itself where two positions
// that are more than pi e_max apart along the path come within 2 e_max of each other.

/// The strip along a path in which coordinates are used: e from `e_min_m` (negative: to the right)
/// to `e_max_m` (to the left).
struct Tube {
  double e_min_m = -5.0;
  double e_max_m = 5.0;

  /// max(|e_min|, |e_max|), called e_max in [SPM, lemma 1].
  [[nodiscard]] double half_width_m() const;
  /// Throws InvalidOption unless e_min <= 0 <= e_max, both finite, one of them not 0.
  void check() const;
};

enum class TubeCondition { kCurvature, kClearance };

/// A stretch of the path that violates a condition, and its worst position.
struct TubeViolation {
  TubeCondition condition = TubeCondition::kCurvature;
  double s_begin_m = 0.0;  ///< begin > end if the stretch crosses the start of a closed path
  double s_end_m = 0.0;
  double s_m = 0.0;                                    ///< worst position
  double other_s_m = 0.0;                              ///< clearance: the other position
  double got = 0.0;                                    ///< curvature [1/m], or distance [m]
  double limit = 0.0;                                  ///< 1 / e_max, or 2 e_max
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< at s_m

  /// "s 120.3 m (12.1, 5.0): curvature: got 0.31, want less than 0.2".
  [[nodiscard]] std::string text() const;
};

struct TubeCheck {
  std::vector<TubeViolation> violations;  ///< curvature first, each kind by s
  /// For every piece of the curve: true if it takes part in no violation, so that a foot point on
  /// it is the only one in the tube.
  std::vector<bool> safe_piece;

  [[nodiscard]] bool one_to_one() const { return violations.empty(); }
};

/// Checks both conditions. Samples distances and refines every near pair, so that it finds
/// violations deeper than a thousandth of e_max. About linear in length / half width.
[[nodiscard]] TubeCheck check_tube(const PathCurve& curve, const Tube& tube);

/// Throws BadInput with every violation if path coordinates are not unique. `name`: of the path,
/// for the message.
void require_one_to_one(const TubeCheck& check, const std::string& name);

/// The largest symmetric half width, at most `most_m`, for which [SPM, lemma 1] holds, to a
/// precision of `step_m`.
[[nodiscard]] double widest_tube_m(const PathCurve& curve, double most_m, double step_m = 0.05);

}  // namespace roadbook
