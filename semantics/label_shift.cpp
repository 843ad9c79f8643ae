#include "semantics/label_shift.hpp"

#include <algorithm>
#include <cmath>

#include "semantics/label_classes.hpp"

namespace roadbook {
namespace {

// Covariances below this are those of a fixed first keyframe.
constexpr double kLeastSigmaM = 1e-3;

double sigmas_of(const Eigen::Vector2d& shift, const Eigen::Matrix2d& covariance) {
  const Eigen::Matrix2d sum =
      covariance + kLeastSigmaM * kLeastSigmaM * Eigen::Matrix2d::Identity();
  return std::sqrt(std::max(0.0, shift.dot(sum.ldlt().solve(shift))));
}

bool is_thing(const Label& label) {
  return label.state == LabelState::kActive && !is_rejected_kind(label.kind);
}

}  // namespace

LabelShifts label_shifts(const Map& before, const Map& after, const std::vector<Label>& labels) {
  LabelShifts result;
  for (const Label& label : labels) {
    if (!is_thing(label)) continue;
    const auto from = vehicle_of(before, label.anchor);
    const auto to = vehicle_of(after, label.anchor);
    if (!from || !to) {
      result.without_anchor.push_back(label);
      continue;
    }
    const auto seen = seen_in_map(before, label);
    LabelShift shift{label, seen->middle, seen_in_map(after, label)->middle, 0.0, 0.0};
    shift.turned_rad =
        std::remainder(heading_of(to->T_map_vehicle) - heading_of(from->T_map_vehicle), 2.0 * M_PI);
    shift.sigmas = sigmas_of(shift.after - shift.before, seen->covariance);
    result.shifts.push_back(std::move(shift));
  }
  return result;
}

LabelShifts shifts_since_seen(const Map& map, const std::vector<Label>& labels) {
  LabelShifts result;
  for (const Label& label : labels) {
    if (!is_thing(label)) continue;
    const auto now = seen_in_map(map, label);
    if (!now) {
      result.without_anchor.push_back(label);
    } else if (label.seen) {
      result.shifts.push_back(
          {label, label.seen->middle, now->middle, 0.0,
           sigmas_of(now->middle - label.seen->middle, label.seen->covariance)});
    }
  }
  return result;
}

double shift_quantile_m(const std::vector<LabelShift>& shifts, double q) {
  std::vector<double> metres;
  for (const LabelShift& shift : shifts) metres.push_back(shift.metres());
  if (metres.empty()) return 0.0;
  std::sort(metres.begin(), metres.end());
  const auto last = static_cast<double>(metres.size() - 1);
  return metres[static_cast<std::size_t>(std::lround(q * last))];
}

}  // namespace roadbook
