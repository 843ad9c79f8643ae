#pragma once

#include <span>
#include <vector>

namespace roadbook {

// Counts of groups whose items share their luck: the log odds of every item of a group lie off
// those expected by one normal deviation of standard deviation `scatter` (a Poisson-binomial with a
// logit-normal effect of the group); below 0.05: the Poisson-binomial alone.

/// What a group came to.
struct GroupCount {
  std::vector<double> chances;  ///< of each item to be counted, in (0, 1)
  int count = 0;

  [[nodiscard]] double expected() const;
};

/// log probability of the group's count. By the trapezoidal rule, to 1e-3 up to a scatter of 2 and
/// 400 items; items whose log odds differ by less than 0.1 may be taken for alike.
[[nodiscard]] double group_log(const GroupCount& group, double scatter);
/// Probability of that count or fewer.
[[nodiscard]] double group_tail(const GroupCount& group, double scatter);
/// log density of a group of which only a part of the expected share is left: up to `kMostLeft`,
/// all parts equally likely beforehand; of items alike.
inline constexpr double kMostLeft = 0.4;
[[nodiscard]] double fallen_log(const GroupCount& group);

/// The scatter of groups: the largest that the counts do not refuse at 95 % (one-sided, profile
/// likelihood), where few groups tell held by what is usual (half normal, 0.3). A share of the
/// groups may have fallen, and does not count as scatter. Within 0.05 and 2.
[[nodiscard]] double scatter_of(std::span<const GroupCount> groups);

}  // namespace roadbook
