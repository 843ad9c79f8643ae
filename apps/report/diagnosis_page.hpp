#pragma once

#include <string>

#include "diagnosis/diagnose.hpp"

namespace roadbook {

/// Returns one self-contained HTML page. It shows the causes with size, confidence interval,
/// evidence and gain. For each cause it shows the residuals before and after, against the covariate
/// that is most informative. It also shows the checks and the effects that are not observable.
[[nodiscard]] std::string diagnosis_page(const Diagnosis& diagnosis, const std::string& drive);

/// Draws the bin means of the residuals before and after, with a band of two standard errors.
[[nodiscard]] std::string evidence_svg(const EvidencePlot& plot);

}  // namespace roadbook
