#pragma once

#include <utility>

#include "diagnosis/inference/candidate.hpp"

namespace roadbook {

/// A term of the grammar whose covariate is a column of the log. Its penalty is
/// 5 nats instead of 2: a log may have columns without a meaning for the diagnosis, and covariates
/// of the car's motion are preferred.
[[nodiscard]] inline Candidate logged_term(Candidate term) {
  term.logged = true;
  term.penalty = 5.0;
  return term;
}

}  // namespace roadbook
