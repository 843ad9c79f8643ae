#pragma once

#include <optional>
#include <string>

#include "diagnosis/diagnose.hpp"
#include "workflows/diagnosis/advice.hpp"

namespace roadbook {

/// Returns one self-contained HTML page. Its first screen says what is wrong, by how much, how sure
/// that is and what to do (`advice_of`). Below it each cause has the residuals before and after,
/// against the covariate that is most informative, and its evidence in a fold-out. Then the page
/// says what was checked and is fine, and what another drive would show.
[[nodiscard]] std::string diagnosis_page(const Diagnosis& diagnosis,
                                         const std::string& drive,
                                         const std::optional<StatedVehicle>& stated = {});

/// Draws the bin means of the residuals before and after, with a band of two standard errors.
[[nodiscard]] std::string evidence_svg(const EvidencePlot& plot);

}  // namespace roadbook
