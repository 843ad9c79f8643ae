#pragma once

#include <string>
#include <vector>

#include "roadnet/paths/path_curve.hpp"

namespace roadbook {

// Where path coordinates are one to one [SPM, Lemma 1]. The tube of half width e_max about a path
// folds onto itself where the path bends as tightly as 1 / e_max. It meets itself where two places
// farther apart than pi e_max along the path come within 2 e_max of each other.

/// The strip beside a path in which coordinates are used: e from `e_min_m` (to the right: negative)
/// to `e_max_m` (to the left).
struct Tube {
  double e_min_m = -5.0;
  double e_max_m = 5.0;

  /// max(|e_min|, |e_max|): what Lemma 1 calls e_max.
  [[nodiscard]] double half_width_m() const;
  /// Throws InvalidOption unless e_min <= 0 <= e_max, both finite, one of them not 0.
  void check() const;
};

enum class TubeCondition { kCurvature, kClearance };

/// A stretch of the path that breaks a condition, and its worst place.
struct TubeViolation {
  TubeCondition condition = TubeCondition::kCurvature;
  double s_begin_m = 0.0;  ///< on a closed path the stretch may run over the seam: begin > end
  double s_end_m = 0.0;
  double s_m = 0.0;                                    ///< worst place
  double other_s_m = 0.0;                              ///< clearance: the other place
  double got = 0.0;                                    ///< curvature [1/m], or distance [m]
  double limit = 0.0;                                  ///< 1 / e_max, or 2 e_max
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< at s_m

  /// "s 120.3 m (12.1, 5.0): curvature: got 0.31, want less than 0.2".
  [[nodiscard]] std::string text() const;
};

struct TubeCheck {
  std::vector<TubeViolation> violations;  ///< curvature first, each kind by s
  /// For every piece of the curve: whether no place of it takes part in a violation, so that a foot
  /// point found there is the only one in the tube.
  std::vector<bool> safe_piece;

  [[nodiscard]] bool one_to_one() const { return violations.empty(); }
};

/// Checks both conditions. Distances are sampled and every near pair is then refined: a violation
/// is found where it is deeper than a thousandth of e_max. About linear in length / half width.
[[nodiscard]] TubeCheck check_tube(const PathCurve& curve, const Tube& tube);

/// For a path that must be one to one: BadInput with every violation where it touches or folds onto
/// itself. `name` is what the path is called in the message.
void require_one_to_one(const TubeCheck& check, const std::string& name);

/// The largest symmetric half width, at most `most_m`, for which Lemma 1 holds, to `step_m`.
[[nodiscard]] double widest_tube_m(const PathCurve& curve, double most_m, double step_m = 0.05);

}  // namespace roadbook
