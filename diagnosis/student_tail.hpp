#pragma once

namespace roadbook {

/// Upper tail of Student's t distribution with `freedom` (odd) degrees of freedom, but 1e-15 at
/// least: rounding errors are as large. Of what is no number 1: nothing is told.
[[nodiscard]] double student_tail(double t, int freedom);

}  // namespace roadbook
