#pragma once

#include <span>

namespace roadbook {

// Counts of groups whose items share their luck: the log odds of a group lie off those expected by
// a normal deviation of standard deviation `scatter` (logit-normal binomial); 0: the binomial.

/// What a group came to.
struct GroupCount {
  int items = 0;
  int count = 0;
  double mean = 0.5;  ///< expected share of the items, in (0, 1)
};

/// log probability of the group's count. By the trapezoidal rule, to 1e-3 up to a scatter of 2 and
/// 400 items.
[[nodiscard]] double group_log(const GroupCount& group, double scatter);
/// Probability of that count or fewer.
[[nodiscard]] double group_tail(const GroupCount& group, double scatter);
/// log density of a group of which only a part of the expected share is left: up to `kMostLeft`,
/// all parts equally likely beforehand.
inline constexpr double kMostLeft = 0.4;
[[nodiscard]] double fallen_log(const GroupCount& group);

/// The scatter of groups: the largest that the counts do not refuse at 95 % (one-sided, profile
/// likelihood), where few groups tell held by what is usual (half normal, 0.3). A share of the
/// groups may have fallen, and does not count as scatter. Within 0.05 and 2.
[[nodiscard]] double scatter_of(std::span<const GroupCount> groups);

}  // namespace roadbook
