#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mapping/map.hpp"
#include "semantics/labels/label_agreement.hpp"
#include "semantics/labels/label_diff.hpp"
#include "semantics/labels/label_effort.hpp"
#include "semantics/labels/label_evidence.hpp"
#include "semantics/labels/label_shift.hpp"

namespace roadbook {

/// The labels of a map, and their movement with it [metric-semantic maps, Fig. 12].
struct LabelReport {
  LabelLedger effort;
  std::string before;  ///< name of the earlier state; empty: since each label was last seen
  std::vector<LabelDifference> differences;  ///< the users' changes since that state
  LabelShifts shifts;
  std::vector<std::vector<Eigen::Vector2d>> outlines;         ///< now
  std::vector<std::vector<Eigen::Vector2d>> outlines_before;  ///< of the earlier state
  LabelAgreement agreement;             ///< of stored sightings and of those found now
  std::vector<LabelEvidence> evidence;  ///< from the newest session's images, if requested

  /// Returns the labels whose paint has disappeared.
  [[nodiscard]] std::vector<std::int64_t> gone() const;
  /// Returns the labels that moved farther than their covariance predicts, the farthest first.
  [[nodiscard]] std::vector<LabelShift> to_look_at() const;
};

/// Collects the labels of a map. Empty if the map has no labels. `before` is an earlier state of
/// the map, or empty. `images` are the images in which to search for labels in the newest session,
/// or empty. Throws BadInput if the earlier state begins with another drive or has no drive of the
/// map.
[[nodiscard]] std::optional<LabelReport> collect_labels(const std::filesystem::path& map_file,
                                                        const Map& map,
                                                        const std::filesystem::path& before,
                                                        const KeyframeImages& images = {});

}  // namespace roadbook
