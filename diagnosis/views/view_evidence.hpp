#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "diagnosis/inference/cause_problem.hpp"
#include "diagnosis/views/view_system.hpp"

namespace roadbook {

/// For each row the residual and its derivative by the size of an effect, both whitened.
struct ViewResiduals {
  struct Row {
    ViewRow row;
    bool second = false;  ///< y of a view
    double left = 0.0;
    double moved = 0.0;
  };
  std::vector<Row> rows;
};
/// Residuals and derivatives at the point of linearisation. `sum`: weights of the elementary
/// columns that make up the effect.
[[nodiscard]] ViewResiduals view_residuals(const ViewSystem& system, const Eigen::VectorXd& sum);

/// Plot for the report: residuals along the direction in which the effect moves them, in the
/// channel that it changes most, against the covariate that it grows with (image radius, row, speed
/// ...). `before`, `after`: without and with the effect in the model.
[[nodiscard]] EvidencePlot view_evidence(const ViewData& data,
                                         const std::vector<ChannelName>& channels,
                                         const Candidate& cause,
                                         const ViewResiduals& before,
                                         const ViewResiduals& after);

}  // namespace roadbook
