#pragma once

#include <Eigen/Core>

#include "diagnosis/inference/cause_problem.hpp"
#include "diagnosis/views/view_fit.hpp"

namespace roadbook {

// Lines of accepted hinges as unknowns of a fit. A refit estimates the turn and the shift of each
// line together with the size of the hinge. Otherwise the interval of the size would ignore the
// uncertainty of the line.

/// Conversion between a hinge candidate and its line. The place of the candidate is the pivot of
/// the line; its heading is the direction of the normal.
[[nodiscard]] HingeLine line_of(const Candidate& hinge);
void set_line(const HingeLine& line, Candidate& hinge);

[[nodiscard]] bool has_hinge(const CauseModel& model);

/// Weights of elementary columns for the turn and the shift of each accepted hinge with a size
/// other than 0: one row an elementary column, two columns a hinge, in the order of
/// `model.accepted`.
[[nodiscard]] Eigen::MatrixXd line_columns(const ViewBasis& basis,
                                           const CauseModel& model,
                                           const ViewPoint& point);
/// The line turned by step[0] [rad] about its pivot and shifted by step[1] [m]. A step beyond the
/// trust region is shortened; its direction is kept.
[[nodiscard]] HingeLine line_moved(const HingeLine& line, const Eigen::Vector2d& step);
/// Applies such steps to all hinges of a model, in the order of `line_columns`. Returns false if
/// any step was shortened.
bool move_lines(const Eigen::VectorXd& steps,
                const ViewBasis& basis,
                const ViewPoint& point,
                CauseModel& model);

/// Prior precisions for `lines` columns of `line_columns`: 1/rad^2 for turns, 1/m^2 for shifts.
/// They keep lines in place that the data do not constrain.
[[nodiscard]] Eigen::VectorXd line_precision(Eigen::Index lines);
/// Information and score of the prior of a joint fit: `others` for the sizes of the model, then
/// `line_precision` for the `lines` columns behind them.
[[nodiscard]] ViewPrior prior_with_lines(const SizePrior& others,
                                         const CauseModel& model,
                                         Eigen::Index lines);
/// Marginal information of the first `sizes` unknowns, with the lines behind them eliminated (Schur
/// complement).
[[nodiscard]] Eigen::MatrixXd marginal_information(const Eigen::MatrixXd& information,
                                                   Eigen::Index sizes);
/// Projects the last `lines` right-hand sides (columns of lines, with their prior) out of all
/// others and removes them.
void project_out_lines(Innovations& innovations, Eigen::Index lines);

}  // namespace roadbook
