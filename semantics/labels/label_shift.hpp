#pragma once

#include <optional>
#include <string>
#include <vector>

#include "semantics/labels/labels.hpp"

namespace roadbook {

// How far labels move when the map changes, and which of them a person should check. Source:
// [metric-semantic maps, Fig. 12].

struct LabelShift {
  Label label;
  Eigen::Vector2d before = Eigen::Vector2d::Zero();  ///< position of its middle, map frame [m]
  Eigen::Vector2d after = Eigen::Vector2d::Zero();
  /// Change of the middle's height [m], and change of heading of the anchor's vehicle [rad]. Empty
  /// in `shifts_since_seen`, because Label::seen stores only x and y.
  std::optional<double> raised_m{};
  std::optional<double> turned_rad{};
  /// Of the position before, in its least certain direction; NaN: unknown.
  double sigma_m = 0.0;
  /// Mahalanobis distance of the shift, with the covariance of the position before; NaN: unknown.
  double sigmas = 0.0;

  /// Horizontal length of the shift.
  [[nodiscard]] double metres() const { return (after - before).norm(); }
};

struct LabelShifts {
  std::vector<LabelShift> shifts;        ///< by id
  std::vector<Label> without_anchor;     ///< labels without a position in one of the maps
  std::vector<std::string> only_before;  ///< names of sessions that only the map before has
  std::vector<std::string> only_after;
};

/// Index in `to` of the drive that is session `session` of `from` (same digest). If several match,
/// the one with the same index is preferred, else the first. Empty if `to` lacks the drive.
[[nodiscard]] std::optional<int> same_session(const Map& from, int session, const Map& to);

/// A label of `from` with its anchor's session renumbered for `to`; empty if `to` lacks the drive.
[[nodiscard]] std::optional<Label> label_for(const Map& from, const Map& to, Label label);

/// Shifts of all active labels between two states of a map; `labels` belong to `after`. Sessions
/// are matched by drive. Both maps must begin with the same drive, since its first keyframe defines
/// the map frame. Rejections are left out.
[[nodiscard]] LabelShifts label_shifts(const Map& before,
                                       const Map& after,
                                       const std::vector<Label>& labels);

/// Shifts from the positions at which a person last saw the labels (Label::seen) to the current
/// ones.
[[nodiscard]] LabelShifts shifts_since_seen(const Map& map, const std::vector<Label>& labels);

/// A larger shift is not explained by the covariance: a person should check the label.
inline constexpr double kLargestShiftSigmas = 3.0;

/// Mean horizontal length of the shifts [m]; 0 without shifts.
[[nodiscard]] double mean_shift_m(const std::vector<LabelShift>& shifts);

/// Quantile `q` (0 to 1) of the horizontal lengths of the shifts [m]; 0 without shifts.
[[nodiscard]] double shift_quantile_m(const std::vector<LabelShift>& shifts, double q);

}  // namespace roadbook
