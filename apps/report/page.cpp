#include "apps/report/page.hpp"

#include <algorithm>
#include <cmath>

#include "apps/report/html.hpp"
#include "apps/report/label_section.hpp"
#include "apps/report/network_section.hpp"
#include "apps/report/occupancy_section.hpp"
#include "apps/report/page_style.hpp"
#include "apps/report/quality_section.hpp"
#include "apps/report/speed_section.hpp"
#include "apps/report/svg_plot.hpp"
#include "apps/report/value_table.hpp"
#include "apps/summaries/offset_text.hpp"
#include "base/format.hpp"
#include "mapping/store/map_file_names.hpp"

namespace roadbook {
namespace {

std::string tile(const std::string& value, const std::string& name) {
  return "<div class=\"tile\"><b>" + escaped(value) + "</b><span>" + escaped(name) +
         "</span></div>\n";
}

std::string headline(const ReportData& data) {
  const Map& map = data.map;
  const auto accepted = static_cast<std::size_t>(std::count_if(
      map.loops.begin(), map.loops.end(), [](const LoopEdge& loop) { return loop.accepted; }));
  std::string html = "<div class=\"tiles\">";
  html += tile(fixed(driven_m(map), 0) + " m", "driven");
  html +=
      tile(std::to_string(map.sessions.size()), map.sessions.size() == 1 ? "session" : "sessions");
  html += tile(std::to_string(map.keyframes.size()), "keyframes");
  html += tile(std::to_string(map.landmarks.size()), "landmarks");
  html += tile(std::to_string(accepted) + " / " + std::to_string(map.loops.size()),
               "loops accepted / tried");
  html += tile(fixed(sample_quantile(
                         {data.quality.residuals_px.begin(), data.quality.residuals_px.end()}, 0.5),
                     2) +
                   " px",
               "reprojection error, median");
  for (const TruthComparison& truth : data.truth.sessions)
    html += tile(fixed(100.0 * truth.error.median_m, 1) + " cm",
                 "error against truth, median" +
                     (map.sessions.size() > 1 ? ", session " + std::to_string(truth.session + 1)
                                              : std::string()));
  if (data.truth.together && map.sessions.size() > 1)
    html += tile(fixed(100.0 * data.truth.together->median_m, 1) + " cm",
                 "error against truth, median, all sessions together");
  if (data.network)
    html += tile(std::to_string(data.network->lanes.size()) + " / " +
                     std::to_string(data.network->intersections.size()),
                 "lanes / intersections");
  return html + "</div>\n";
}

std::string overview(const ReportData& data) {
  const Map& map = data.map;
  const auto points = driven_positions(map);
  PlanBounds bounds = PlanBounds::around(points);
  // Landmarks near the driven path need a small margin. A margin for far landmarks would make the
  // path small.
  bounds.low.array() -= 8.0;
  bounds.high.array() += 8.0;
  PlanPlot plot(bounds);
  const GroundPicture landmarks = landmark_picture(map, bounds);
  plot.image(data_uri("image/png", landmarks.png), landmarks.place);
  for (const TruthComparison& truth : data.truth.sessions) plot.polyline(truth.truth, "truth");
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> accepted;
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> rejected;
  for (const LoopEdge& loop : map.loops)
    (loop.accepted ? accepted : rejected)
        .emplace_back(points[static_cast<std::size_t>(loop.from)],
                      points[static_cast<std::size_t>(loop.to)]);
  std::vector<Eigen::Vector2d> line;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    line.push_back(points[i]);
    const bool last = i + 1 == map.keyframes.size() || map.keyframes[i + 1].after_gap ||
                      map.keyframes[i + 1].session != map.keyframes[i].session;
    if (!last) continue;
    plot.polyline(line, "track s" + std::to_string(map.keyframes[i].session % 6));
    line.clear();
  }
  plot.segments(rejected, "rejected");
  plot.segments(accepted, "accepted");
  std::vector<Eigen::Vector2d> met;
  for (const auto& [from, to] : accepted) met.push_back(to);
  plot.dots(met, 1.6, "met");
  if (!points.empty()) {
    plot.dots({points.front()}, 4.0, "start");
    plot.label(points.front(), "start", "note");
  }
  std::string caption;
  for (std::size_t i = 0; i < map.sessions.size(); ++i)
    caption += html_key("track s" + std::to_string(i % 6), map.sessions[i].name);
  if (!data.truth.sessions.empty()) caption += html_key("truth", "truth");
  caption += html_key("accepted", "loop accepted") + html_key("rejected", "loop rejected") +
             "Grey: landmarks from above.";
  return html_section("The map from above",
                      html_figure(plot.svg("trajectory, loops and landmarks from above"), caption));
}

std::string sessions(const ReportData& data) {
  std::vector<HtmlRow> rows;
  for (std::size_t i = 0; i < data.map.sessions.size(); ++i) {
    const Session& session = data.map.sessions[i];
    const auto truth =
        std::find_if(data.truth.sessions.begin(), data.truth.sessions.end(),
                     [&](const auto& t) { return t.session == static_cast<int>(i); });
    const bool has = truth != data.truth.sessions.end();
    rows.push_back({session.name, std::to_string(session.rig.cameras.size()),
                    fixed(static_cast<double>(session.t_end_ns - session.t_begin_ns) * 1e-9, 0),
                    std::string(scale_source_name(session.scale_source)),
                    fixed(100.0 * session.scale_sigma, 2),
                    session.wheels ? fixed(session.wheel_scale, 4) : "no wheels",
                    has ? fixed(100.0 * truth->error.median_m, 1) : "-",
                    has ? fixed(100.0 * truth->error.p95_m, 1) : "-",
                    has ? offset_text(truth->offset) : "-"});
  }
  std::string html =
      html_table({"session", "cameras", "seconds", "scale from", "scale sigma [%]", "wheel scale",
                  "error median [cm]", "error 95 % [cm]", "off the other sessions"},
                 rows);
  if (data.map.sessions.size() > 1 && data.truth.together)
    html += "<p>One alignment of all sessions with the truth leaves " +
            fixed(100.0 * data.truth.together->median_m, 1) + " cm median, " +
            fixed(100.0 * data.truth.together->p95_m, 1) +
            " cm 95 %. The errors of each session hold after its own alignment; the last column "
            "says how that differs from the common one.</p>";
  else if (!data.truth.apart.empty())
    html += "<p>The sessions are not compared together: " + escaped(data.truth.apart) + ".</p>";
  for (const std::string& line : data.truth.without_truth) html += "<p>" + escaped(line) + ".</p>";
  return html_section("Sessions", html + value_table(data.map, data.value));
}

std::string overhead(const ReportData& data) {
  if (!data.overhead) return "";
  PlanPlot plot(data.overhead->place);
  plot.image(data_uri("image/png", data.overhead->png), data.overhead->place);
  return html_section(
      "Overhead image",
      html_figure(plot.svg("overhead image"),
                  "The ground as the cameras saw it, made smaller. The full image is the "
                  "layer <code>overhead</code> of the map."));
}

std::string speeds(const ReportData& data) {
  if (!data.speeds) return "";
  std::vector<std::vector<Eigen::Vector2d>> lanes;
  if (data.network)
    for (const Lane& lane : data.network->lanes) {
      lanes.emplace_back();
      for (const auto& p : lane.centre) lanes.back().push_back(p.head<2>());
    }
  return html_section("Speed and friction", speed_figures(*data.speeds, lanes));
}

std::string experiments(const std::vector<EvaluationFigure>& figures) {
  std::string html;
  for (const EvaluationFigure& one : figures)
    html += html_figure("<img alt=\"" + escaped(one.name) + "\" src=\"" + one.data_uri + "\">",
                        escaped(one.name));
  return html.empty() ? html : html_section("Experiments", html);
}

std::string run_times(const ReportData& data) {
  if (data.stages.empty()) return "";
  std::vector<NamedBar> bars;
  double sum = 0.0;
  for (const StageRow& stage : data.stages) {
    bars.push_back({stage.name, stage.seconds,
                    fixed(stage.seconds, 1) + " s, " + fixed(stage.peak_rss_mb, 0) + " MB"});
    sum += stage.seconds;
  }
  return html_section(
      "Time and memory",
      html_figure(bars_svg(bars), "Stages of the build and the peak of memory so far: " +
                                      fixed(sum, 1) + " s in all."));
}

std::string warnings(const ReportData& data) {
  if (data.warnings.empty()) return html_section("Warnings", "<p>None.</p>");
  constexpr std::size_t kMostLines = 60;
  std::string html = "<ul class=\"warnings\">";
  for (std::size_t i = 0; i < std::min(kMostLines, data.warnings.size()); ++i)
    html += "<li>" + escaped(data.warnings[i]) + "</li>";
  if (data.warnings.size() > kMostLines)
    html += "<li>and " + std::to_string(data.warnings.size() - kMostLines) + " more</li>";
  return html_section("Warnings", html + "</ul>");
}

std::string provenance(const ReportData& data) {
  std::vector<HtmlRow> rows = {{"file", data.file.filename().string()},
                               {"state", data.meta.state},
                               {"digest", data.meta.digest}};
  for (const Session& session : data.map.sessions)
    rows.push_back({"drive " + session.name, session.drive_digest});
  for (const char* name : {"seed", "gauge"})
    if (const auto value = data.meta.values.find(name); value != data.meta.values.end())
      rows.push_back({name, value->second});
  return html_section("Provenance", html_table({"", ""}, rows));
}

}  // namespace

std::string report_page(const ReportData& data,
                        const LabelRounds& rounds,
                        const std::vector<EvaluationFigure>& evaluation) {
  const std::string title = data.file.stem().string();
  return "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         escaped(title) + " - roadbook report</title>\n<style>" + std::string(kPageStyle) +
         "</style></head><body><main>\n<header><p>roadbook report</p><h1>" + escaped(title) +
         "</h1></header>\n" + headline(data) + overview(data) + overhead(data) +
         network_section(data) + (data.labels ? label_section(*data.labels, rounds) : "") +
         occupancy_section(data) + speeds(data) + experiments(evaluation) + quality_section(data) +
         sessions(data) + loops_section(data) + run_times(data) + warnings(data) +
         provenance(data) + "</main></body></html>\n";
}

}  // namespace roadbook
