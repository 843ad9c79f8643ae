#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "diagnosis/inference/cause_problem.hpp"

namespace roadbook {

// What problems whose readings are linear in all sizes share.

/// Sides are the residual (`readings` less the accepted sizes' part), the accepted columns and
/// those of the candidates that change anything; `white` turns sides into innovations.
[[nodiscard]] Projection linear_projection(
    const CauseModel& model,
    std::vector<Candidate> candidates,
    Eigen::VectorXd readings,
    const std::function<Eigen::MatrixXd(const Candidate&)>& columns,
    const std::function<Innovations(const Eigen::MatrixXd&)>& white);

/// Computes sizes, information and log likelihood of the model from its own projection. The sizes
/// also use the prior `others` from other data.
void linear_fit(const Projection& projection, CauseModel& model, const SizePrior& others = {});

}  // namespace roadbook
