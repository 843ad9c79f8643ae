#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "diagnosis/inference/cause_problem.hpp"
#include "diagnosis/views/view_system.hpp"

namespace roadbook {

/// Of each row: what the model leaves, and how much a cause moves it.
struct ViewResiduals {
  struct Row {
    ViewRow row;
    bool second = false;  ///< y of a view
    double left = 0.0;
    double moved = 0.0;
  };
  std::vector<Row> rows;
};
/// At the system's point; `sum`: the cause as a sum of elementary columns.
[[nodiscard]] ViewResiduals view_residuals(const ViewSystem& system, const Eigen::VectorXd& sum);

/// For the eye: residuals in the direction in which the cause moves them, in the channel that it
/// moves most, against what it grows with (image radius, row, speed, ...).
[[nodiscard]] EvidencePlot view_evidence(const ViewData& data,
                                         const std::vector<ChannelName>& channels,
                                         const Candidate& cause,
                                         const ViewResiduals& before,
                                         const ViewResiduals& after);

}  // namespace roadbook
