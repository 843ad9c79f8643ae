#include "semantics/labels/label_shift.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "semantics/labels/label_classes.hpp"

namespace roadbook {
namespace {

// A standard deviation below this value belongs to the fixed first keyframe.
constexpr double kLeastSigmaM = 1e-3;

double sigmas_of(const Eigen::Vector2d& shift, const Eigen::Matrix2d& covariance) {
  const Eigen::Matrix2d sum =
      covariance + kLeastSigmaM * kLeastSigmaM * Eigen::Matrix2d::Identity();
  return std::sqrt(std::max(0.0, shift.dot(sum.ldlt().solve(shift))));
}

LabelShift shift_from(const Label& label, const LabelSeen& seen, const Eigen::Vector2d& now) {
  LabelShift shift{label, seen.middle, now};
  if (!is_known(seen.covariance)) {
    shift.sigma_m = shift.sigmas = std::numeric_limits<double>::quiet_NaN();
    return shift;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(seen.covariance);
  shift.sigma_m = std::sqrt(std::max(0.0, axes.eigenvalues()[1]));
  shift.sigmas = sigmas_of(shift.after - shift.before, seen.covariance);
  return shift;
}

bool is_thing(const Label& label) {
  return label.state == LabelState::kActive && !is_rejected_kind(label.kind);
}

std::vector<std::string> sessions_lacking_in(const Map& other, const Map& map) {
  std::vector<std::string> names;
  for (std::size_t s = 0; s < map.sessions.size(); ++s)
    if (!same_session(map, static_cast<int>(s), other)) names.push_back(map.sessions[s].name);
  return names;
}

}  // namespace

std::optional<int> same_session(const Map& from, int session, const Map& to) {
  const auto number = static_cast<std::size_t>(session);
  if (number >= from.sessions.size()) return std::nullopt;
  const std::string& digest = from.sessions[number].drive_digest;
  if (number < to.sessions.size() && to.sessions[number].drive_digest == digest) return session;
  for (std::size_t s = 0; s < to.sessions.size(); ++s)
    if (to.sessions[s].drive_digest == digest) return static_cast<int>(s);
  return std::nullopt;
}

std::optional<Label> label_for(const Map& from, const Map& to, Label label) {
  const auto session = same_session(from, label.anchor.session, to);
  if (!session) return std::nullopt;
  label.anchor.session = *session;
  return label;
}

LabelShifts label_shifts(const Map& before, const Map& after, const std::vector<Label>& labels) {
  LabelShifts result;
  result.only_before = sessions_lacking_in(after, before);
  result.only_after = sessions_lacking_in(before, after);
  for (const Label& label : labels) {
    if (!is_thing(label)) continue;
    const auto earlier = label_for(after, before, label);
    const auto from = earlier ? vehicle_of(before, earlier->anchor) : std::nullopt;
    const auto to = vehicle_of(after, label.anchor);
    if (!from || !to) {
      result.without_anchor.push_back(label);
      continue;
    }
    LabelShift shift =
        shift_from(label, *seen_in_map(before, *earlier), seen_in_map(after, label)->middle);
    const Eigen::Vector3d middle = middle_of(label);
    shift.raised_m = (to->T_map_vehicle * middle).z() - (from->T_map_vehicle * middle).z();
    shift.turned_rad =
        std::remainder(heading_of(to->T_map_vehicle) - heading_of(from->T_map_vehicle), 2.0 * M_PI);
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
      result.shifts.push_back(shift_from(label, *label.seen, now->middle));
    }
  }
  return result;
}

double mean_shift_m(const std::vector<LabelShift>& shifts) {
  double sum = 0.0;
  for (const LabelShift& shift : shifts) sum += shift.metres();
  return shifts.empty() ? 0.0 : sum / static_cast<double>(shifts.size());
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
