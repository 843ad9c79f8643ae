#include "apps/summaries/localise_summary.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/summary_json.hpp"
#include "base/format.hpp"
#include "base/text.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::ordered_json;

Json number(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Json lost_json(const std::vector<LostSpan>& spans) {
  Json all = Json::array();
  for (const LostSpan& span : spans)
    all.push_back(
        {{"begin_ns", span.t_begin_ns}, {"end_ns", span.t_end_ns}, {"frames", span.frames}});
  return all;
}

Json truth_json(const LocalisationTruth& truth) {
  return {{"frames", truth.frames},
          {"median_m", number(truth.median_m)},
          {"p95_m", number(truth.p95_m)},
          {"max_m", number(truth.max_m)},
          {"along_median_m", number(truth.along_median_m)},
          {"across_median_m", number(truth.across_median_m)},
          {"heading_median_rad", number(truth.heading_median_rad)},
          {"heading_p95_rad", number(truth.heading_p95_rad)},
          {"recall_0_1_m", truth.recall_0_1_m},
          {"recall_0_2_m", truth.recall_0_2_m},
          {"recall_0_5_m", truth.recall_0_5_m},
          {"nees", number(truth.nees)},
          {"in_ellipse", number(truth.in_ellipse)}};
}

std::string percent(double share) { return fixed(100.0 * share, 1) + " %"; }

}  // namespace

std::optional<StartPose> start_pose(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const auto refuse = [&] {
    throw InvalidOption("--start", text, "X,Y,HEADING: three numbers [m, m, rad]");
  };
  std::vector<double> numbers;
  for (const std::string_view part : split(text)) {
    const auto value = parse_double(part);
    if (!value || !std::isfinite(*value)) refuse();
    numbers.push_back(*value);
  }
  if (numbers.size() != 3) refuse();
  return StartPose{numbers[0], numbers[1], numbers[2]};
}

std::vector<std::string> localisation_lines(const LocalisationFigures& f) {
  std::string line = std::to_string(f.localised) + " of " + std::to_string(f.frames) +
                     " frames localised, " + std::to_string(f.predicted) +
                     " by the motion alone, " + std::to_string(f.lost.size()) + " times lost";
  if (f.inliers_median)
    line += "; " + fixed(*f.inliers_median, 0) + " landmarks in the median frame";
  if (f.cpu_ms_median) line += ", " + fixed(*f.cpu_ms_median, 1) + " ms of one core";
  std::vector<std::string> lines{line};
  if (f.truth && f.truth->frames > 0)
    lines.push_back("truth: median " + fixed(100.0 * f.truth->median_m, 1) + " cm, 95 % within " +
                    fixed(100.0 * f.truth->p95_m, 1) + " cm, largest " +
                    fixed(100.0 * f.truth->max_m, 1) + " cm; " + percent(f.truth->recall_0_1_m) +
                    " of the frames within 10 cm");
  return lines;
}

Json to_json(const LocalisationFigures& f) {
  return {{"frames", f.frames},
          {"localised", f.localised},
          {"predicted", f.predicted},
          {"lost", lost_json(f.lost)},
          {"relocalised", f.relocalised},
          {"inliers", {{"median", number(f.inliers_median)}, {"p5", number(f.inliers_p5)}}},
          {"cpu_ms", {{"median", number(f.cpu_ms_median)}, {"p99", number(f.cpu_ms_p99)}}},
          {"jumps_m", {{"median", number(f.jump_median_m)}, {"p999", number(f.jump_p999_m)}}},
          {"truth", f.truth ? truth_json(*f.truth) : Json(nullptr)}};
}

void print_localisation(const Console& console, const LocaliseResult& result) {
  console.warn(result.warnings);
  for (const std::string& line : localisation_lines(result.figures)) console.say(line);
  Json json = to_json(result.figures);
  json["map_digest"] = result.map_digest;
  json["sessions_used"] = result.sessions_used;
  json["warnings"] = to_json(result.warnings);
  console.result(json);
}

}  // namespace roadbook
