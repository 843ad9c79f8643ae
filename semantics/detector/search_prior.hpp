#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace roadbook {

// What a search brings up has another prior than the examples a classifier learnt from: the best of
// very many windows look more like the thing than they are, and things are rarer among them. Of
// what was found and then answered both are known, what the classifier said before it was told and
// what it is; one shift of the logit makes the answers most likely (Saerens, Latinne and
// Decaestecker 2002 for known priors; Platt 1999 with the slope left at one).

/// A thing that a search found, with what somebody said about it afterwards.
struct SearchAnswer {
  double logit = 0.0;  ///< of the probability it was found with, without any shift
  bool positive = false;
  friend bool operator==(const SearchAnswer&, const SearchAnswer&) = default;
};

/// The shift of the logit under which the answers are most likely, held near zero by a prior of
/// standard deviation 2, and of less where fewer than ten answers are of the rarer kind; 0 where
/// there are none of one kind. Of answers in the order they were given the later half counts, a
/// hundred at least: the first classifiers knew little, and what they took for the thing says
/// nothing of the last one.
[[nodiscard]] double prior_shift(const std::vector<SearchAnswer>& answers);
/// The same of several sources, of each its later half.
[[nodiscard]] double prior_shift_of(std::span<const std::vector<SearchAnswer>> sources);

/// Expected calibration error over ten bins of probability: of what was said, and whether it was
/// so. 0 of nothing.
[[nodiscard]] double calibration_error(const std::vector<std::pair<double, bool>>& said);

/// The error that chance alone gives to probabilities that are exactly right: the fewer things were
/// said, the larger.
struct ChanceOfCalibration {
  double mean = 0.0;
  double most = 0.0;  ///< not passed in 95 of 100 draws
};
/// By drawing, a thousand times, whether each thing is so with the probability said of it.
[[nodiscard]] ChanceOfCalibration chance_of_calibration(
    const std::vector<std::pair<double, bool>>& said, std::uint64_t seed);

}  // namespace roadbook
