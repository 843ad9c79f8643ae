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

/// Log probability of the group's count, by the trapezoidal rule, to 1e-3 up to a scatter of 2 and
/// 400 items. Items whose log odds differ by less than 0.1 may be treated as equal.
[[nodiscard]] double group_log(const GroupCount& group, double scatter);
/// Probability of that count or fewer.
[[nodiscard]] double group_tail(const GroupCount& group, double scatter);
/// Log density of the counts of a group that lost most of its items. The remaining part lies
/// between 0 and `kMostLeft`; all parts are equally likely a priori. The items are treated as
/// equal.
inline constexpr double kMostLeft = 0.4;
[[nodiscard]] double fallen_log(const GroupCount& group);

/// Scatter of the groups: the largest value that the counts do not reject at 95 % (one-sided,
/// profile likelihood). With few groups a half-normal prior (0.3) holds it. A share of the groups
/// may have fallen and does not count as scatter. Between 0.05 and 2.
[[nodiscard]] double scatter_of(std::span<const GroupCount> groups);

}  // namespace roadbook
