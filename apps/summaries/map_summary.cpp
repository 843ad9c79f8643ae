#include "apps/summaries/map_summary.hpp"

#include <nlohmann/json.hpp>

#include "apps/summaries/offset_text.hpp"
#include "apps/summary_json.hpp"
#include "apps/vehicle_option.hpp"
#include "base/format.hpp"
#include "mapping/pipeline/map_paths.hpp"
#include "mapping/store/map_file.hpp"
#include "mapping/store/map_file_names.hpp"

namespace roadbook {
namespace {

std::string or_unknown(const std::optional<double>& value, int decimals) {
  return value ? fixed(*value, decimals) : "-";
}

// One line a camera. The session is named if there are several.
void say_cameras(const Console& console, const MapSummary& summary) {
  for (const CameraFigures& c : summary.cameras) {
    std::string line = summary.sessions > 1 ? c.session + "/" + c.camera : c.camera;
    line += ": " + std::to_string(c.landmarks) + " landmarks, ";
    line += c.fit_share ? fixed(100.0 * *c.fit_share, 0) + " %" : std::string("-");
    line += " of " + std::to_string(c.corners) + " corners fit, mean residual [px] ";
    line += c.residual ? "radial " + fixed(c.residual->radial_px, 2) + ", tangential " +
                             fixed(c.residual->tangential_px, 2) + ", horizontal " +
                             fixed(c.residual->horizontal_px, 2) + ", vertical " +
                             fixed(c.residual->vertical_px, 2)
                       : std::string("-");
    if (c.paired_share) line += ", " + fixed(100.0 * *c.paired_share, 0) + " % of images paired";
    console.say(line);
  }
}

// One line for all sessions and, of several, one for each.
void say_map_truth(const Console& console, const MapSummary& summary) {
  if (summary.ate_median_m && summary.ate_p95_m)
    console.say((summary.sessions > 1 ? "against the truth, all sessions together: "
                                      : "against the drive's truth: ") +
                fixed(*summary.ate_median_m, 3) + " m median, " + fixed(*summary.ate_p95_m, 3) +
                " m 95 %");
  else if (!summary.truth_apart.empty())
    console.say("against the truth: sessions are not compared together, because " +
                summary.truth_apart);
  if (summary.sessions == 1) return;
  for (const SessionTruth& s : summary.truth_sessions)
    console.say(s.session + " alone: " + or_unknown(s.ate_median_m, 3) + " m median, " +
                or_unknown(s.ate_p95_m, 3) +
                " m 95 %; off the other sessions: " + offset_text(s.offset));
}

void say_summary(const Console& console, const MapSummary& summary) {
  console.say(std::to_string(summary.keyframes) + " keyframes, " +
              std::to_string(summary.landmarks) + " landmarks, " +
              std::to_string(summary.loops_accepted) + " loops accepted, " +
              std::to_string(summary.loops_rejected) + " rejected");
  if (summary.localised_share)
    console.say(fixed(100.0 * *summary.localised_share, 0) +
                " % of the drive's keyframes localised in the map");
  console.say("reprojection error " + or_unknown(summary.reprojection_median_px, 2) +
              " px median, " + or_unknown(summary.reprojection_rms_px, 2) + " px rms");
  say_cameras(console, summary);
  if (summary.components > 1)
    console.say(std::to_string(summary.components) +
                " pieces that nothing joins: other commands refuse this map");
  console.say("scale from " + std::string(scale_source_name(summary.scale_source)) +
              (summary.scale_sigma ? ", +- " + fixed(100.0 * *summary.scale_sigma, 2) + " %"
                                   : std::string(", +- unknown")));
  say_vehicle(console, sources_of(summary.vehicles));
  say_map_truth(console, summary);
  double seconds = 0.0;
  for (const StageTime& stage : summary.stages) seconds += stage.seconds;
  console.say("built in " + fixed(seconds, 1) + " s");
}

void say_rows(const Console& console, const EqualRowsUsed& rows) {
  console.say(std::to_string(rows.rows) + " rows of equal spaces took part (" +
              std::to_string(rows.spaces) + " spaces), " + std::to_string(rows.refused) +
              " did not fit");
}

// Stores times and warnings of this run for `report`. They depend on the machine, so the content
// digest does not include them. Files are named as seen from the map.
void remember_run(const std::filesystem::path& map, const MapResult& result) {
  MapSummary summary = result.summary;
  summary.warnings = problems_from_map(summary.warnings, result.drives, map);
  MapUpdate update(map);
  update.set_meta("place.summary", to_json(summary).dump());
  update.commit();
}

// Returns the summary of the run that made the map, because this run had nothing to do.
nlohmann::ordered_json result_of_last_run(const std::filesystem::path& map,
                                          const MapSummary& summary) {
  auto result = to_json(summary);
  const auto values = load_meta(map).values;
  const auto note = values.find("place.summary");
  if (note != values.end()) {
    const auto run = nlohmann::ordered_json::parse(note->second, nullptr, false);
    for (const char* key : {"reprojection_px", "truth", "truth_sessions", "rows", "cameras"})
      if (run.is_object() && run.contains(key)) result[key] = run[key];
  } else {
    result["reprojection_px"] = {{"median", nullptr}, {"rms", nullptr}};
  }
  result["unchanged"] = true;
  result["dropped"] = nlohmann::ordered_json::array();
  return result;
}

void print_unchanged(const Console& console,
                     const MapSummary& summary,
                     const std::filesystem::path& map) {
  console.say(
      "nothing to do: the map was made from these drives, options and seed, by this "
      "version of roadbook");
  console.say("map: " + map.string());
  console.result(result_of_last_run(map, summary));
}

}  // namespace

nlohmann::ordered_json dropped_json(const std::vector<DroppedWork>& dropped) {
  auto list = nlohmann::ordered_json::array();
  for (const DroppedWork& work : dropped)
    list.push_back({{"name", work.name},
                    {"layers", work.layers},
                    {"command", work.command.empty() ? nlohmann::ordered_json()
                                                     : nlohmann::ordered_json(work.command)}});
  return list;
}

void print_map(const Console& console, const MapResult& result, const std::filesystem::path& map) {
  const MapSummary& summary = result.summary;
  if (summary.is_unchanged) return print_unchanged(console, summary, map);
  remember_run(map, result);
  console.warn(summary.warnings);
  console.warn(dropped_warnings(result.dropped, map));
  say_summary(console, summary);
  if (summary.rows) say_rows(console, *summary.rows);
  console.say("map: " + map.string());
  auto object = to_json(summary);
  object["unchanged"] = false;
  object["dropped"] = dropped_json(result.dropped);
  console.result(object);
}

}  // namespace roadbook
