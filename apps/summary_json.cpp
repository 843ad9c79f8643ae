#include "apps/summary_json.hpp"

#include <nlohmann/json.hpp>

#include "apps/vehicle_option.hpp"
#include "mapping/store/map_file_names.hpp"

namespace roadbook {

using nlohmann::ordered_json;

ordered_json to_json(const std::vector<Problem>& problems) {
  ordered_json list = ordered_json::array();
  for (const Problem& problem : problems)
    list.push_back({{"severity", problem.severity == Severity::kError ? "error" : "warning"},
                    {"file", problem.file},
                    {"line", problem.line},
                    {"field", problem.field},
                    {"got", problem.got},
                    {"want", problem.want}});
  return list;
}

namespace {

ordered_json number_or_null(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json();
}

ordered_json cameras_json(const std::vector<CameraFigures>& cameras) {
  auto list = ordered_json::array();
  for (const CameraFigures& c : cameras) {
    ordered_json residual;
    if (c.residual)
      residual = {{"radial", c.residual->radial_px},
                  {"tangential", c.residual->tangential_px},
                  {"horizontal", c.residual->horizontal_px},
                  {"vertical", c.residual->vertical_px}};
    list.push_back({{"session", c.session},
                    {"camera", c.camera},
                    {"keyframes", c.keyframes},
                    {"corners", c.corners},
                    {"landmarks", c.landmarks},
                    {"fit_share", number_or_null(c.fit_share)},
                    {"views", number_or_null(c.views)},
                    {"residual_px", residual},
                    {"paired_share", number_or_null(c.paired_share)},
                    {"late_s", number_or_null(c.late_s)}});
  }
  return list;
}

// `truth` is null if the sessions have truth but no common alignment, and left out without truth.
void add_map_truth(const MapSummary& summary, ordered_json& object) {
  if (summary.truth_sessions.empty() && summary.truth_apart.empty()) return;
  object["truth"] = nullptr;
  if (summary.ate_median_m && summary.ate_p95_m)
    object["truth"] = {{"ate_median_m", *summary.ate_median_m}, {"ate_p95_m", *summary.ate_p95_m}};
  auto list = ordered_json::array();
  for (const SessionTruth& s : summary.truth_sessions)
    list.push_back({{"session", s.session},
                    {"ate_median_m", number_or_null(s.ate_median_m)},
                    {"ate_p95_m", number_or_null(s.ate_p95_m)},
                    {"offset", to_json(s.offset)}});
  object["truth_sessions"] = list;
}

}  // namespace

ordered_json to_json(const std::optional<SessionOffset>& offset) {
  if (!offset) return nullptr;
  return {{"shift_m", offset->shift_m.norm()},
          {"x_m", offset->shift_m.x()},
          {"y_m", offset->shift_m.y()},
          {"z_m", offset->shift_m.z()},
          {"heading_rad", number_or_null(offset->heading_rad)}};
}

ordered_json to_json(const MapSummary& summary) {
  ordered_json object = {
      {"keyframes", summary.keyframes},
      {"landmarks", summary.landmarks},
      {"sessions", summary.sessions},
      {"loops", {{"accepted", summary.loops_accepted}, {"rejected", summary.loops_rejected}}},
      {"reprojection_px",
       {{"median", number_or_null(summary.reprojection_median_px)},
        {"rms", number_or_null(summary.reprojection_rms_px)}}},
      {"scale",
       {{"source", scale_source_name(summary.scale_source)},
        {"sigma", number_or_null(summary.scale_sigma)}}},
      {"pieces", summary.components},
      {"localised_share", number_or_null(summary.localised_share)},
      {"cameras", cameras_json(summary.cameras)}};
  object["vehicle"] = vehicle_json(sources_of(summary.vehicles));
  add_map_truth(summary, object);
  if (summary.rows)
    object["rows"] = {{"used", summary.rows->rows},
                      {"spaces", summary.rows->spaces},
                      {"refused", summary.rows->refused}};
  object["stages"] = ordered_json::array();
  for (const StageTime& stage : summary.stages)
    object["stages"].push_back(
        {{"name", stage.name}, {"seconds", stage.seconds}, {"peak_rss_mb", stage.peak_rss_mb}});
  object["digest"] = summary.digest;
  object["warnings"] = to_json(summary.warnings);
  return object;
}

}  // namespace roadbook
