#pragma once

#include <Eigen/Core>

#include "diagnosis/inference/cause_problem.hpp"
#include "diagnosis/views/view_fit.hpp"

namespace roadbook {

// A found hinge carries its line, which a refit turns and shifts beside its size: a size is no
// better known than its line.

/// The line in which the ground bends by a candidate that is a hinge, and back: its place is the
/// line's pivot, its heading that of the normal.
[[nodiscard]] HingeLine line_of(const Candidate& hinge);
void lay_along(const HingeLine& line, Candidate& hinge);

[[nodiscard]] bool has_hinge(const CauseModel& model);

/// Sums of elementary columns by which the lines of a model's hinges move: turn and shift of each
/// that has a size, in order.
[[nodiscard]] Eigen::MatrixXd line_sums(const ViewBasis& basis,
                                        const CauseModel& model,
                                        const ViewPoint& point);
/// Turned [rad] about its pivot and shifted [m] by `step`, or as much of it as a line may move at
/// once.
[[nodiscard]] HingeLine line_moved(const HingeLine& line, const Eigen::Vector2d& step);
/// The same of a model's lines, in the order of `line_sums`. Whether all moved the whole way.
bool move_lines(const Eigen::VectorXd& steps,
                const ViewBasis& basis,
                const ViewPoint& point,
                CauseModel& model);

/// By how much `lines` columns of `line_sums` are held where nothing shows them (precisions).
[[nodiscard]] Eigen::VectorXd line_precision(Eigen::Index lines);
/// What other data say of a model's sizes, and that behind them.
[[nodiscard]] ViewPull pull_beside(const SizePrior& others,
                                   const CauseModel& model,
                                   Eigen::Index lines);
/// Of the first `sizes` unknowns, the lines behind them projected out.
[[nodiscard]] Eigen::MatrixXd beside_lines(const Eigen::MatrixXd& information, Eigen::Index sizes);
/// Of innovations whose last sides are `lines` columns of lines: the other sides, what lines
/// explain of them taken off.
void take_off_lines(Innovations& innovations, Eigen::Index lines);

}  // namespace roadbook
