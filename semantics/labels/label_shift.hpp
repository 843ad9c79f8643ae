#pragma once

#include <optional>
#include <string>
#include <vector>

#include "semantics/labels/labels.hpp"

namespace roadbook {

// Labels while their map changes (document 004, Fig. 12): how far they moved with the vehicle poses
// they hang on, and which of them a person should look at again.

struct LabelShift {
  Label label;
  Eigen::Vector2d before = Eigen::Vector2d::Zero();  ///< its middle, map frame [m]
  Eigen::Vector2d after = Eigen::Vector2d::Zero();
  /// How far its middle has risen [m], and the vehicle it hangs on has turned, from above. Not
  /// known of a shift since somebody saw the label: that is kept from above.
  std::optional<double> raised_m{};
  std::optional<double> turned_rad{};
  double sigma_m = 0.0;  ///< of the place before, in its least certain direction
  /// Length of the shift in standard deviations of the place before (covariance_in_map).
  double sigmas = 0.0;

  /// From above.
  [[nodiscard]] double metres() const { return (after - before).norm(); }
};

struct LabelShifts {
  std::vector<LabelShift> shifts;        ///< by id
  std::vector<Label> without_anchor;     ///< have no place in one of the maps
  std::vector<std::string> only_before;  ///< sessions that the map after lacks, by name
  std::vector<std::string> only_after;
};

/// The number that a session of `from` has in `to`: the one of the same drive (its digest), the one
/// of the same number where several are. Empty where `to` has none.
[[nodiscard]] std::optional<int> same_session(const Map& from, int session, const Map& to);

/// A label of `from` as it would hang on the same drive in `to`; empty where `to` lacks that.
[[nodiscard]] std::optional<Label> label_for(const Map& from, const Map& to, Label label);

/// Of all active labels between two states of a map, `labels` being those of `after`. Sessions are
/// the same where their drives are, whatever their numbers. Both maps begin with the same drive:
/// their map frame is that of its first keyframe. Rejections are left out.
[[nodiscard]] LabelShifts label_shifts(const Map& before,
                                       const Map& after,
                                       const std::vector<Label>& labels);

/// From where a person last saw each label (Label::seen) to where it is now.
[[nodiscard]] LabelShifts shifts_since_seen(const Map& map, const std::vector<Label>& labels);

/// Beyond it a shift is no longer what the covariance told, and a person should look.
inline constexpr double kLargestShiftSigmas = 3.0;

/// Mean length of the shifts, from above [m]; 0 where there are none.
[[nodiscard]] double mean_shift_m(const std::vector<LabelShift>& shifts);

/// Shift at share `q` of them, 0 to 1 [m]; 0 where there are none.
[[nodiscard]] double shift_quantile_m(const std::vector<LabelShift>& shifts, double q);

}  // namespace roadbook
