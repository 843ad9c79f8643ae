#pragma once

#include <optional>
#include <vector>

#include "diagnosis/inference/cause_problem.hpp"

namespace roadbook {

// References err for seconds: their errors look like an effect that grows and falls with time or
// place. The search takes rows for independent; what it accepts is judged once more here, with the
// errors that remain when every accepted cause is fitted.

/// Innovations without the autocorrelation of their channels' errors: of each of `channels` where
/// neighbouring residuals correlate significantly, every row less its prediction by the rows before
/// (generalised least squares as of Cochrane and Orcutt 1949). Errors that are the sum of a
/// first-order Gauss-Markov process and of white noise become white by this. No value where no
/// channel's errors last.
[[nodiscard]] std::optional<Innovations> without_autocorrelation(
    const Projection& projection, const std::vector<std::size_t>& channels);

struct SizeByBlocks {
  double p = 1.0;      ///< that all sizes of the cause are 0
  double sigma = 0.0;  ///< of its first size in `model`
};

/// Accepted cause `a` of `model`, all accepted sizes fitted again to these innovations. P-value:
/// the larger of that for independent rows and of those by the scatter of blocks of 1, 2, 4, ... s
/// (cluster-robust, F distribution). Standard error: that of the new fit, and how far the new fit
/// moves the size.
[[nodiscard]] SizeByBlocks size_by_blocks(const CauseModel& model,
                                          const Innovations& innovations,
                                          std::size_t a);

}  // namespace roadbook
