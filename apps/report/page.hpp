#pragma once

#include <string>
#include <vector>

#include "apps/report/evaluation_figures.hpp"
#include "apps/report/label_rounds_section.hpp"
#include "workflows/report/report_data.hpp"

namespace roadbook {

/// Returns the page as one self-contained HTML document. `rounds` are the learning rounds of the
/// map's labelling page. `evaluation` goes into the page as it is.
[[nodiscard]] std::string report_page(const ReportData& data,
                                      const LabelRounds& rounds = {},
                                      const std::vector<EvaluationFigure>& evaluation = {});

}  // namespace roadbook
