#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "roadnet/paths/path_curve.hpp"
#include "roadnet/paths/path_tube.hpp"

namespace roadbook {

// Path coordinates [SPM, eq. 5]: s along a path, e the distance from it, positive to the LEFT of
// the direction of travel ([SPM] has the opposite sign: path_sign.hpp).

enum class ProjectionStatus : std::uint8_t {
  kInside,       ///< s and e are set
  kOutsideTube,  ///< no foot point on the path is within the tube
  kBeforeStart,  ///< the nearest point of the path is its open start, and the point lies behind it
  kBeyondEnd,    ///< the nearest point of the path is its open end, and the point lies beyond it
  kNotUnique,    ///< several (s, e) in the tube map to the point
};
[[nodiscard]] const char* to_text(ProjectionStatus status);

struct PathProjection {
  ProjectionStatus status = ProjectionStatus::kOutsideTube;
  double s_m;  ///< NaN unless kInside
  double e_m;  ///< NaN unless kInside
  [[nodiscard]] bool inside() const { return status == ProjectionStatus::kInside; }
};

/// Result position of the last query, where the next query starts its search.
struct PathCursor {
  std::size_t piece = 0;
  double v = 0.0;
};

/// A path and the tube in which its coordinates are used. Immutable: share it between threads, with
/// a cursor for each.
///
/// A point is inside if exactly one (s, e) of the tube maps to it. Where [SPM, lemma 1] holds, one
/// foot point near the last query is sufficient. Otherwise, or if the search near the last query
/// fails, all parts of the path whose tube can hold the point are searched (found by a grid). Tube
/// and ends have a tolerance of 1e-9 m, so that a point survives conversion in both directions.
class PathFrame {
 public:
  /// Checks [SPM, lemma 1]. A path that violates it is still usable; `project` returns kNotUnique
  /// for ambiguous points. Throws InvalidOption for the tube.
  PathFrame(PathCurve curve, const Tube& tube);

  [[nodiscard]] const PathCurve& curve() const { return curve_; }
  [[nodiscard]] const Tube& tube() const { return tube_; }
  /// Stretches that violate [SPM, lemma 1].
  [[nodiscard]] const std::vector<TubeViolation>& violations() const { return check_.violations; }

  /// Path coordinates of a point; the same for any cursor. A point that is not finite is outside.
  [[nodiscard]] PathProjection project(const Eigen::Vector2d& p, PathCursor& cursor) const;
  [[nodiscard]] PathProjection project(const Eigen::Vector2d& p) const;

  /// The point at (s, e) [m, map]; empty outside the tube or beyond an open end.
  [[nodiscard]] std::optional<Eigen::Vector2d> position(double s_m, double e_m) const;

 private:
  struct Arc {
    std::size_t piece;
    double v_begin, v_end;
    PathPiece::Derivatives begin, end;
  };
  struct Foot {
    std::size_t piece;
    double v, s_m, e_m;
    bool folded;  ///< beyond the centre of curvature
  };

  void cut_arcs();
  void register_arcs();
  [[nodiscard]] std::uint64_t cell_of(double x, double y) const;
  [[nodiscard]] bool in_tube(double e_m) const;
  [[nodiscard]] std::optional<Foot> near_foot(const Eigen::Vector2d& p, PathCursor cursor) const;
  [[nodiscard]] std::optional<Foot> foot_on(const Arc& arc, const Eigen::Vector2d& p) const;
  [[nodiscard]] Foot make_foot(std::size_t piece, double v, const Eigen::Vector2d& p) const;
  [[nodiscard]] PathProjection search(const Eigen::Vector2d& p, PathCursor& cursor) const;
  [[nodiscard]] ProjectionStatus why_outside(const Eigen::Vector2d& p) const;

  PathCurve curve_;
  Tube tube_;
  TubeCheck check_;
  double cell_m_ = 1.0;
  std::vector<Arc> arcs_;
  std::unordered_map<std::uint64_t, std::vector<int>> cells_;
};

}  // namespace roadbook
