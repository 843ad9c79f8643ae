#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mapping/sessions/session_value.hpp"
#include "semantics/labels/labels.hpp"
#include "workflows/compare/lane_overlap.hpp"
#include "workflows/compare/map_comparison.hpp"

namespace roadbook {

/// Labels on the ground, by id. Ids are comparable where one map comes from the other.
struct LabelComparison : CommonCounts {
  std::size_t kind_changed = 0;  ///< of `both`: another class
  std::size_t compared = 0;      ///< of `both`: both maps know the place, and a motion joins them
  /// Of `compared`: ids whose middles are apart by more than 10 cm.
  std::vector<std::int64_t> moved;
};

/// Lanes in plan; B's after the motion onto A.
struct LaneComparison {
  double length_a_m = 0.0;
  double length_b_m = 0.0;
  /// Share of the length within 0.5 m of a lane of the other map; empty without a motion, and for
  /// a map without lanes.
  std::optional<double> share_a;
  std::optional<double> share_b;
};

/// A layer or plain table of both maps.
struct CommonLayer {
  std::string name;
  bool same = false;  ///< the digests are equal: same content
};

struct LayerComparison {
  std::vector<CommonLayer> both;  ///< by name
  std::vector<std::string> only_a;
  std::vector<std::string> only_b;
};

/// The comparison of two map files with all that is drawn on them.
struct FileComparison {
  Map a;
  Map b;
  MapComparison maps;
  LabelComparison labels;
  LaneComparison lanes;
  LayerComparison layers;
  /// Of A's sessions for each other; empty if it was not requested, and for one session.
  std::vector<SessionValue> value_a;
  std::vector<SessionValue> value_b;
};

[[nodiscard]] LabelComparison compare_labels(const Map& map_a,
                                             const std::vector<Label>& a,
                                             const Map& map_b,
                                             const std::vector<Label>& b,
                                             const std::optional<Eigen::Isometry3d>& T_a_b);

/// `b` in the coordinates of map B [m].
[[nodiscard]] LaneComparison compare_lanes(const std::vector<std::vector<Eigen::Vector3d>>& a,
                                           const std::vector<std::vector<Eigen::Vector3d>>& b,
                                           const std::optional<Eigen::Isometry3d>& T_a_b);

/// Reads and compares two map files. `with_value`: also computes what the sessions of each map are
/// worth to each other, which takes longer than everything else. Throws BadInput for a file that is
/// no map or damaged, StorageError if a file cannot be read or is replaced meanwhile.
[[nodiscard]] FileComparison compare_files(const std::filesystem::path& a,
                                           const std::filesystem::path& b,
                                           bool with_value = false);

}  // namespace roadbook
