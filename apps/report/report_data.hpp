#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/report/svg_plot.hpp"
#include "mapping/map.hpp"
#include "mapping/similarity.hpp"
#include "mapping/store/map_file.hpp"
#include "roadnet/build_network.hpp"

namespace roadbook {

// The contents of a report, collected from the map file and, for the truth only, from the recorded
// drives.

/// Comparison of a session with the truth of its drive.
struct TruthComparison {
  int session = 0;
  TrajectoryError error;               ///< rigidly aligned; with scale if the map's scale is free
  std::vector<Eigen::Vector2d> truth;  ///< truth in the map frame
  std::vector<Eigen::Vector2d> error_along_m;  ///< travelled [m], error [m]
};

/// A picture on the plane of the map.
struct GroundPicture {
  std::string data_uri;
  PlanBounds place;
};

struct StageRow {
  std::string name;
  double seconds = 0.0;
  double peak_rss_mb = 0.0;
};

/// A figure of `roadbook evaluate`.
struct EvaluationFigure {
  std::string name;  ///< name of its file
  std::string data_uri;
};

struct SpeedReport;  // apps/report/speed_section.hpp
struct LabelReport;  // apps/report/label_section.hpp

struct ReportData {
  std::filesystem::path file;
  MapMeta meta;
  Map map;
  std::vector<float> residuals_px;  ///< of every observation [px of the full-size image]
  std::size_t behind_camera = 0;    ///< observations whose landmark is behind the camera
  std::vector<int> observations_of_keyframe;
  std::vector<int> views_of_landmark;
  std::vector<StageRow> stages;  ///< empty if the map has no such notes
  std::vector<std::string> warnings;
  std::vector<TruthComparison> truth;
  std::vector<std::string> without_truth;  ///< the reason, one line per session
  std::optional<GroundPicture> overhead;
  std::optional<RoadNetwork> network;         ///< as stored in the map
  RoadNetworkStages stages_of_network;        ///< recomputed for the pictures
  std::shared_ptr<const SpeedReport> speeds;  ///< null if the map has neither speeds nor friction
  std::vector<EvaluationFigure> evaluation;   ///< as requested
  std::shared_ptr<const LabelReport> labels;  ///< null if the map has no labels
};

/// Collects the data of the report. Throws BadInput for a map that cannot be used. If a drive is
/// not available, the report only lacks its truth. `before` is an earlier state of the map, for the
/// movement of labels since then; or empty. `look_again`: also search for the labels in the images
/// of the newest session.
[[nodiscard]] ReportData collect_report(const std::filesystem::path& map_file,
                                        const std::filesystem::path& before = {},
                                        bool look_again = false);

/// Draws the landmarks from above. A place is darker if it has more landmarks.
[[nodiscard]] GroundPicture landmark_picture(const Map& map, const PlanBounds& place);

/// Returns the page as one self-contained HTML document.
[[nodiscard]] std::string report_page(const ReportData& data);

}  // namespace roadbook
