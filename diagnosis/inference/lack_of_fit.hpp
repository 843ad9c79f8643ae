#pragma once

#include <vector>

#include "diagnosis/inference/score_table.hpp"
#include "diagnosis/inference/search_result.hpp"

namespace roadbook {

/// Tests for lack of fit that would reveal a wrong effect: the size of an effect depends on speed,
/// turning, time, ... (`CauseProblem::variations`), or an effect with a similar column improves the
/// fit. The level is 5 % for each effect, corrected for the number of its tests.
[[nodiscard]] std::vector<FitWarning> lack_of_fit_warnings(const CauseProblem& problem,
                                                           const CauseModel& model,
                                                           const ScoreTable& table);

}  // namespace roadbook
