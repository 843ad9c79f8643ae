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

// What a report shows, gathered from the map file and, for truth alone, from the recorded drives.

/// A session against the truth of its drive.
struct TruthComparison {
  int session = 0;
  TrajectoryError error;               ///< rigidly aligned; with scale where the map's is free
  std::vector<Eigen::Vector2d> truth;  ///< truth in the map frame
  std::vector<Eigen::Vector2d> error_along_m;  ///< travelled [m], error [m]
};

/// A picture that lies on the map's plane.
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
  std::string name;  ///< of its file
  std::string data_uri;
};

struct SpeedReport;  // apps/report/speed_section.hpp
struct LabelReport;  // apps/report/label_section.hpp

struct ReportData {
  std::filesystem::path file;
  MapMeta meta;
  Map map;
  std::vector<float> residuals_px;  ///< of every observation [px of the full-size image]
  std::size_t behind_camera = 0;    ///< observations whose landmark the model cannot see
  std::vector<int> observations_of_keyframe;
  std::vector<int> views_of_landmark;
  std::vector<StageRow> stages;  ///< empty where the map does not tell
  std::vector<std::string> warnings;
  std::vector<TruthComparison> truth;
  std::vector<std::string> without_truth;  ///< why, one line a session
  std::optional<GroundPicture> overhead;
  std::optional<RoadNetwork> network;   ///< as stored in the map
  RoadNetworkStages stages_of_network;  ///< recomputed for the pictures
  std::shared_ptr<const SpeedReport>
      speeds;                                ///< null where the map has neither speeds nor friction
  std::vector<EvaluationFigure> evaluation;  ///< as asked for
  std::shared_ptr<const LabelReport> labels;  ///< null if the map has no labels
};

/// Collects the data of the report. Throws BadInput for a map that cannot be used. If a drive is
/// not available, the report only lacks its truth. `before` is an earlier state of the map, for the
/// movement of labels since then; or empty. `look_again`: also search for the labels in the images
/// of the newest session.
[[nodiscard]] ReportData collect_report(const std::filesystem::path& map_file,
                                        const std::filesystem::path& before = {},
                                        bool look_again = false);

/// Landmarks from above as a picture: darker where there are more.
[[nodiscard]] GroundPicture landmark_picture(const Map& map, const PlanBounds& place);

/// The page: one HTML document that needs nothing else.
[[nodiscard]] std::string report_page(const ReportData& data);

}  // namespace roadbook
