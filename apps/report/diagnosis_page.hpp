#pragma once

#include <string>

#include "diagnosis/diagnose.hpp"

namespace roadbook {

/// One self-contained HTML page: causes with size, interval, evidence and gain, each with the
/// residuals before and after against the covariate that tells; checks; what cannot be seen.
[[nodiscard]] std::string diagnosis_page(const Diagnosis& diagnosis, const std::string& drive);

/// Bin means of what the model leaves, before and after, with the band of two standard errors.
[[nodiscard]] std::string evidence_svg(const EvidencePlot& plot);

}  // namespace roadbook
