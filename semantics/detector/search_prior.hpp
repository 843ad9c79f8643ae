#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace roadbook {

// Corrects probabilities for the prior of searches. A search returns the best of very many windows:
// positives are rarer among them than among the training examples, and they look more like
// positives than they are. Each answered hypothesis gives a pair: its predicted logit before
// training on it, and the truth. One shift of the logit is fitted to these pairs by maximum
// likelihood (Saerens, Latinne and Decaestecker 2002 for known priors; Platt 1999 with the slope
// fixed to one).

/// A hypothesis of a search, with the answer that a person gave.
struct SearchAnswer {
  double logit = 0.0;  ///< logit of the predicted probability, without any shift
  bool positive = false;
  friend bool operator==(const SearchAnswer&, const SearchAnswer&) = default;
};

/// Maximum a posteriori shift of the logit. The prior has mean 0 and standard deviation 2, less if
/// there are fewer than ten answers of the rarer kind. Returns 0 if one kind is missing. Only the
/// later half of the answers is used, at least the last hundred, because the errors of the first
/// classifiers do not describe the last one.
[[nodiscard]] double prior_shift(const std::vector<SearchAnswer>& answers);
/// Same for several sources; of each only the later half is used.
[[nodiscard]] double prior_shift_of(std::span<const std::vector<SearchAnswer>> sources);

/// Expected calibration error with ten bins, for pairs of predicted probability and truth; 0
/// without pairs.
[[nodiscard]] double calibration_error(const std::vector<std::pair<double, bool>>& said);

/// Expected calibration error of exactly calibrated probabilities, which is above zero because of
/// the finite number of pairs.
struct ChanceOfCalibration {
  double mean = 0.0;
  double most = 0.0;  ///< 95 % quantile
};
/// Estimated by 1,000 draws of the truth from the predicted probabilities.
[[nodiscard]] ChanceOfCalibration chance_of_calibration(
    const std::vector<std::pair<double, bool>>& said, std::uint64_t seed);

}  // namespace roadbook
