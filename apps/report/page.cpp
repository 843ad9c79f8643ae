#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <regex>

#include "apps/format.hpp"
#include "apps/report/page_style.hpp"
#include "apps/report/report_data.hpp"
#include "apps/report/speed_section.hpp"
#include "mapping/map_file_names.hpp"

namespace roadbook {
namespace {

using Row = std::vector<std::string>;

std::string table(const Row& head, const std::vector<Row>& rows) {
  std::string html = "<div class=\"scroll\"><table><thead><tr>";
  for (const std::string& cell : head) html += "<th>" + escaped(cell) + "</th>";
  html += "</tr></thead><tbody>";
  for (const Row& row : rows) {
    html += "<tr>";
    for (const std::string& cell : row) html += "<td>" + escaped(cell) + "</td>";
    html += "</tr>";
  }
  return html + "</tbody></table></div>\n";
}

std::string section(const std::string& title, const std::string& body) {
  return "<section><h2>" + escaped(title) + "</h2>\n" + body + "</section>\n";
}

std::string figure(const std::string& svg, const std::string& caption) {
  return "<figure>" + svg + "<figcaption>" + caption + "</figcaption></figure>\n";
}

std::string key(const std::string& css_class, const std::string& name) {
  return "<span class=\"key\"><svg viewBox=\"0 0 22 8\"><path class=\"" + css_class +
         "\" d=\"M1 4H21\"/></svg>" + escaped(name) + "</span> ";
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return NAN;
  const auto at = static_cast<std::size_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

std::vector<double> as_doubles(const auto& values) {
  return std::vector<double>(values.begin(), values.end());
}

std::vector<Eigen::Vector2d> positions(const Map& map) {
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i)
    points.push_back(map.T_map_vehicle(static_cast<int>(i)).translation().head<2>());
  return points;
}

double driven_m(const Map& map) {
  double sum = 0.0;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i)
    if (i + 1 == map.keyframes.size() || map.keyframes[i + 1].session != map.keyframes[i].session)
      sum += map.keyframes[i].travelled_m;
  return sum;
}

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
  html += tile(fixed(quantile(as_doubles(data.residuals_px), 0.5), 2) + " px",
               "reprojection error, median");
  for (const TruthComparison& truth : data.truth)
    html += tile(fixed(100.0 * truth.error.median_m, 1) + " cm",
                 "error against truth, median" +
                     (map.sessions.size() > 1 ? ", session " + std::to_string(truth.session + 1)
                                              : std::string()));
  if (data.network)
    html += tile(std::to_string(data.network->lanes.size()) + " / " +
                     std::to_string(data.network->intersections.size()),
                 "lanes / intersections");
  return html + "</div>\n";
}

std::string overview(const ReportData& data) {
  const Map& map = data.map;
  const auto points = positions(map);
  PlanBounds bounds = PlanBounds::around(points);
  // Landmarks reach a little beyond the driven path; far ones would make the picture small.
  bounds.low.array() -= 8.0;
  bounds.high.array() += 8.0;
  PlanPlot plot(bounds);
  const GroundPicture landmarks = landmark_picture(map, bounds);
  plot.image(landmarks.data_uri, landmarks.place);
  for (const TruthComparison& truth : data.truth) plot.polyline(truth.truth, "truth");
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
    caption += key("track s" + std::to_string(i % 6), map.sessions[i].name);
  if (!data.truth.empty()) caption += key("truth", "truth");
  caption += key("accepted", "loop accepted") + key("rejected", "loop rejected") +
             "Grey: landmarks from above.";
  return section("The map from above",
                 figure(plot.svg("trajectory, loops and landmarks from above"), caption));
}

// "100 corners agree" -> "N corners agree": one row a kind of reason.
std::string kind_of(const std::string& reason) {
  static const std::regex number("[0-9]+(\\.[0-9]+)?");
  return std::regex_replace(reason, number, "N");
}

std::string loops(const ReportData& data) {
  if (data.map.loops.empty())
    return section("Loops", "<p>No place was seen twice, or none was recognised.</p>");
  std::map<std::pair<bool, std::string>, std::pair<int, int>> reasons;
  for (const LoopEdge& loop : data.map.loops) {
    auto& [count, inliers] = reasons[{!loop.accepted, kind_of(loop.reason)}];
    ++count;
    inliers += loop.inliers;
  }
  std::vector<Row> rows;
  for (const auto& [reason, sums] : reasons)
    rows.push_back({reason.first ? "rejected" : "accepted", reason.second,
                    std::to_string(sums.first), fixed(1.0 * sums.second / sums.first, 0)});
  return section("Loops", table({"", "reason", "loops", "mean inliers"}, rows));
}

std::string statistics(const ReportData& data) {
  const auto residuals = as_doubles(data.residuals_px);
  const double reach = std::max(1.0, std::ceil(quantile(residuals, 0.99)));
  std::string html = "<div class=\"pair\">";
  html +=
      figure(histogram_svg(residuals, 0.0, reach, 40, "reprojection error [px]", "observations"),
             "Distance between seen and predicted pixel, full-size image: median " +
                 fixed(quantile(residuals, 0.5), 2) + " px, 95 % " +
                 fixed(quantile(residuals, 0.95), 2) + " px.");
  std::vector<Eigen::Vector2d> seen;
  for (std::size_t i = 0; i < data.observations_of_keyframe.size(); ++i)
    seen.emplace_back(static_cast<double>(i), data.observations_of_keyframe[i]);
  html += figure(line_chart_svg(seen, "keyframe", "observations"),
                 "Landmarks seen in each keyframe, all cameras together.");
  const auto views = as_doubles(data.views_of_landmark);
  const double most = std::max(10.0, std::ceil(quantile(views, 0.99)));
  html += figure(histogram_svg(views, 0.0, most, std::min(40, static_cast<int>(most)),
                               "images that see a landmark", "landmarks"),
                 "Mean " +
                     fixed(views.empty() ? 0.0
                                         : std::accumulate(views.begin(), views.end(), 0.0) /
                                               static_cast<double>(views.size()),
                           1) +
                     " images a landmark.");
  for (const TruthComparison& truth : data.truth)
    html += figure(
        line_chart_svg(truth.error_along_m, "driven [m]", "error [m]"),
        "Distance from the drive's truth along the drive" +
            (data.map.sessions.size() > 1
                 ? " (" + escaped(data.map.sessions[static_cast<std::size_t>(truth.session)].name) +
                       ")"
                 : std::string()) +
            ".");
  return section("Quality", html + "</div>");
}

std::string sessions(const ReportData& data) {
  std::vector<Row> rows;
  for (std::size_t i = 0; i < data.map.sessions.size(); ++i) {
    const Session& session = data.map.sessions[i];
    const auto truth = std::find_if(data.truth.begin(), data.truth.end(), [&](const auto& t) {
      return t.session == static_cast<int>(i);
    });
    const bool has = truth != data.truth.end();
    rows.push_back({session.name, std::to_string(session.rig.cameras.size()),
                    fixed(static_cast<double>(session.t_end_ns - session.t_begin_ns) * 1e-9, 0),
                    std::string(scale_source_name(session.scale_source)),
                    fixed(100.0 * session.scale_sigma, 2),
                    session.wheels ? fixed(session.wheel_scale, 4) : "no wheels",
                    has ? fixed(100.0 * truth->error.median_m, 1) : "-",
                    has ? fixed(100.0 * truth->error.p95_m, 1) : "-"});
  }
  std::string html = table({"session", "cameras", "seconds", "scale from", "scale sigma [%]",
                            "wheel scale", "error median [cm]", "error 95 % [cm]"},
                           rows);
  for (const std::string& line : data.without_truth) html += "<p>" + escaped(line) + ".</p>";
  return section("Sessions", html);
}

std::string overhead(const ReportData& data) {
  if (!data.overhead) return "";
  PlanPlot plot(data.overhead->place);
  plot.image(data.overhead->data_uri, data.overhead->place);
  return section("Overhead image",
                 figure(plot.svg("overhead image"),
                        "The ground as the cameras saw it, made smaller. The full image is the "
                        "layer <code>overhead</code> of the map."));
}

std::string network_panel(const PlanBounds& bounds,
                          const RoadGraph& graph,
                          const std::string& caption) {
  PlanPlot plot(bounds, 440.0, 360.0);
  std::vector<Eigen::Vector2d> nodes;
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> edges;
  for (int i = 0; i < graph.size(); ++i) {
    const auto node = static_cast<std::size_t>(i);
    if (graph.degree(i) > 0) nodes.emplace_back(graph.positions[node].head<2>());
    for (const int j : graph.neighbours[node])
      if (j > i)
        edges.emplace_back(graph.positions[node].head<2>(),
                           graph.positions[static_cast<std::size_t>(j)].head<2>());
  }
  plot.segments(edges, "edge");
  plot.dots(nodes, 1.5, "node");
  return figure(plot.svg(caption), escaped(caption) + ": " + std::to_string(nodes.size()) +
                                       " nodes, " + std::to_string(edges.size()) + " edges.");
}

std::string road_network(const ReportData& data) {
  if (!data.network) return "";
  const RoadNetwork& network = *data.network;
  const PlanBounds bounds = PlanBounds::around(positions(data.map));
  PlanPlot lanes(bounds, 440.0, 360.0);
  std::vector<Row> rows;
  for (std::size_t i = 0; i < network.lanes.size(); ++i) {
    const Lane& lane = network.lanes[i];
    std::vector<Eigen::Vector2d> centre;
    for (const auto& p : lane.centre) centre.push_back(p.head<2>());
    lanes.polyline(centre, "lane s" + std::to_string(i % 6));
    rows.push_back({std::to_string(lane.id), fixed(lane.length_m, 1), fixed(lane.width_m, 2),
                    lane.one_way() ? "one way" : "both ways",
                    std::to_string(lane.forward_passes + lane.backward_passes),
                    std::to_string(lane.reverse_gear_passes)});
  }
  std::vector<Eigen::Vector2d> joints;
  for (const Intersection& joint : network.intersections)
    joints.push_back(joint.position.head<2>());
  lanes.dots(joints, 4.0, "joint");
  const RoadNetworkStages& stages = data.stages_of_network;
  std::string html = "<div class=\"pair\">";
  html += network_panel(bounds, stages.full, "a) Driven graph");
  html += network_panel(bounds, stages.one_loop, "b) After one loop of pruning");
  html += network_panel(bounds, stages.finished, "c) Finished");
  html += figure(lanes.svg("lanes"),
                 "d) Lanes between intersections: " + std::to_string(network.lanes.size()) +
                     " lanes, " + std::to_string(network.intersections.size()) + " intersections.");
  html += "</div><p>" + fixed(network.length_m, 1) + " m of lanes; " +
          fixed(100.0 * network.coverage, 1) + " % of the driven positions lie within " +
          fixed(network.reach_m, 2) + " m of them.</p>";
  html +=
      table({"lane", "length [m]", "spread [m]", "direction", "passes", "in reverse gear"}, rows);
  return section("Road network", html);
}

std::string speeds(const ReportData& data) {
  if (!data.speeds) return "";
  std::vector<std::vector<Eigen::Vector2d>> lanes;
  if (data.network)
    for (const Lane& lane : data.network->lanes) {
      lanes.emplace_back();
      for (const auto& p : lane.centre) lanes.back().push_back(p.head<2>());
    }
  std::string html = speed_figures(*data.speeds, lanes);
  if (!data.speeds->ages.empty())
    html += table({"item", "layer", "date", "weight left", ""}, data.speeds->ages);
  return section("Speed and friction", html);
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
  return section("Time and memory",
                 figure(bars_svg(bars), "Stages of the build and the peak of memory so far: " +
                                            fixed(sum, 1) + " s in all."));
}

std::string warnings(const ReportData& data) {
  if (data.warnings.empty()) return section("Warnings", "<p>None.</p>");
  constexpr std::size_t kMostLines = 60;
  std::string html = "<ul class=\"warnings\">";
  for (std::size_t i = 0; i < std::min(kMostLines, data.warnings.size()); ++i)
    html += "<li>" + escaped(data.warnings[i]) + "</li>";
  if (data.warnings.size() > kMostLines)
    html += "<li>and " + std::to_string(data.warnings.size() - kMostLines) + " more</li>";
  return section("Warnings", html + "</ul>");
}

std::string provenance(const ReportData& data) {
  std::vector<Row> rows = {{"file", data.file.filename().string()},
                           {"state", data.meta.state},
                           {"digest", data.meta.digest}};
  for (const Session& session : data.map.sessions)
    rows.push_back({"drive " + session.name, session.drive_digest});
  for (const char* name : {"seed", "gauge"})
    if (const auto value = data.meta.values.find(name); value != data.meta.values.end())
      rows.push_back({name, value->second});
  return section("Provenance", table({"", ""}, rows));
}

}  // namespace

std::string report_page(const ReportData& data) {
  const std::string title = data.file.stem().string();
  return "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         escaped(title) + " - roadbook report</title>\n<style>" + std::string(kPageStyle) +
         "</style></head><body><main>\n<header><p>roadbook report</p><h1>" + escaped(title) +
         "</h1></header>\n" + headline(data) + overview(data) + overhead(data) +
         road_network(data) + speeds(data) + statistics(data) + sessions(data) + loops(data) +
         run_times(data) + warnings(data) + provenance(data) + "</main></body></html>\n";
}

}  // namespace roadbook
