#pragma once

#include <string>
#include <vector>

#include "diagnosis/inference/score_table.hpp"

namespace roadbook {

/// A reason to doubt a name that was found, although the name explains much: "depends on speed".
struct FitWarning {
  std::string name;
  std::string text;
};

/// Tests for lack of fit that would reveal a wrong effect: the size of an effect depends on speed,
/// turning, time, ... (`CauseProblem::variations`), or an effect with a similar column improves the
/// fit. The level is 5 % for each effect, corrected for the number of its tests.
[[nodiscard]] std::vector<FitWarning> lack_of_fit_warnings(const CauseProblem& problem,
                                                           const CauseModel& model,
                                                           const ScoreTable& table);

}  // namespace roadbook
