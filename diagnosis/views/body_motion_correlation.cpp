#include "diagnosis/views/body_motion_correlation.hpp"

#include <algorithm>

namespace roadbook {
namespace {

// Index one past the run of consecutive motions that starts at `first` and covers `length_m` [m].
// Returns `first` if the drive ends or is interrupted before that length.
std::size_t end_of_way(const std::vector<MotionConstraint>& motions,
                       std::size_t first,
                       double length_m) {
  double way = 0.0;
  for (std::size_t m = first; m < motions.size(); ++m) {
    if (m > first && motions[m].from != motions[m - 1].to) break;
    way += motions[m].T_from_to.translation().norm();
    if (way >= length_m) return m + 1;
  }
  return first;
}

}  // namespace

std::array<double, 6> motion_variance_inflation(const std::vector<MotionConstraint>& motions,
                                                double wheelbase_m,
                                                const std::array<std::vector<double>, 6>& left) {
  std::array<double, 6> together{};
  std::array<double, 6> alone{};
  for (std::size_t first = 0; first < motions.size(); ++first) {
    const std::size_t end = end_of_way(motions, first, wheelbase_m);
    for (std::size_t axis = 2; axis < 5 && end > first; ++axis) {
      double sum = 0.0;
      for (std::size_t m = first; m < end; ++m) {
        sum += left[axis][m];
        alone[axis] += left[axis][m] * left[axis][m];
      }
      together[axis] += sum * sum;
    }
  }
  std::array<double, 6> ratios{};
  for (std::size_t axis = 0; axis < 6; ++axis)
    ratios[axis] = alone[axis] > 0.0 ? std::max(1.0, together[axis] / alone[axis]) : 1.0;
  return ratios;
}

}  // namespace roadbook
