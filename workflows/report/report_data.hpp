#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mapping/map.hpp"
#include "mapping/sessions/session_value.hpp"
#include "mapping/store/map_file.hpp"
#include "roadnet/build_network.hpp"
#include "workflows/occupancy/occupancy_demands.hpp"
#include "workflows/report/ground_picture.hpp"
#include "workflows/report/label_report.hpp"
#include "workflows/report/map_quality.hpp"
#include "workflows/report/speed_report.hpp"
#include "workflows/report/truth_comparison.hpp"

namespace roadbook {

/// A stage of the build of a map.
struct StageRow {
  std::string name;
  double seconds = 0.0;
  double peak_rss_mb = 0.0;
};

/// The contents of a report about a map, without their presentation.
struct ReportData {
  std::filesystem::path file;
  MapMeta meta;
  Map map;
  MapQuality quality;
  std::vector<StageRow> stages;  ///< of the build; empty if the map has no such notes
  std::vector<std::string> warnings;
  TruthComparisons truth;
  std::optional<GroundPicture> overhead;
  std::optional<RoadNetwork> network;         ///< as stored in the map
  RoadNetworkStages stages_of_network;        ///< recomputed for the pictures
  std::optional<SpeedReport> speeds;          ///< empty without speeds and friction
  std::optional<OccupancyDemands> occupancy;  ///< empty if the map has no occupancy grid
  std::optional<LabelReport> labels;          ///< empty if the map has no labels
  std::vector<SessionValue> value;  ///< of its sessions for each other; empty for one session
};

/// Collects the data of the report. Throws BadInput for a map that cannot be used. If a drive is
/// not available, the report only lacks its truth. `before` is an earlier state of the map, for the
/// movement of labels since then; or empty. `look_again`: also search for the labels in the images
/// of the newest session.
[[nodiscard]] ReportData collect_report(const std::filesystem::path& map_file,
                                        const std::filesystem::path& before = {},
                                        bool look_again = false);

}  // namespace roadbook
