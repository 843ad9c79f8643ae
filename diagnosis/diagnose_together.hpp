#pragma once

#include <vector>

#include "diagnosis/inference/findings.hpp"
#include "diagnosis/sessions_problem.hpp"

namespace roadbook {

/// Diagnosis of one kind of readings of several drives together. With a single drive, its effects
/// count as the vehicle's. Empty without drives.
[[nodiscard]] Diagnosis diagnose_together(const std::vector<SessionProblem>& drives,
                                          const SearchOptions& options);

}  // namespace roadbook
