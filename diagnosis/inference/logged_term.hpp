#pragma once

#include <utility>

#include "diagnosis/inference/candidate.hpp"

namespace roadbook {

/// A term of the grammar whose covariate is a column of the log. It pays 5 nats in the place of 2:
/// whoever logs a column may not have meant it, and what the car does comes first.
[[nodiscard]] inline Candidate logged_term(Candidate term) {
  term.logged = true;
  term.penalty = 5.0;
  return term;
}

}  // namespace roadbook
