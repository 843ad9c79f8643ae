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

/// Lack of fit where a wrong name would show it: the size of a name depends on speed, turning,
/// time,
/// ... (`CauseProblem::variations`), or one whose column is like its own wants to stand beside it.
/// Tested at 5 % for each name, corrected for the number of such tests of it.
[[nodiscard]] std::vector<FitWarning> lack_of_fit_warnings(const CauseProblem& problem,
                                                           const CauseModel& model,
                                                           const ScoreTable& table);

}  // namespace roadbook
