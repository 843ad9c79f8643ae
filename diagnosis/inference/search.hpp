#pragma once

#include "diagnosis/inference/search_result.hpp"

namespace roadbook {

/// Selects the effects that the data support, by stepwise model selection (search.cpp lists the
/// steps). The result holds the final model, its effects with size, p-value, evidence and held-out
/// gain, the effects confounded with each, and those that the data cannot show.
/// Deterministic. Throws Interrupted.
[[nodiscard]] SearchResult search_causes(const CauseProblem& problem,
                                         const SearchOptions& options = {});

}  // namespace roadbook
