#include "apps/report/compare_page.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "apps/report/html.hpp"
#include "apps/report/page_style.hpp"
#include "apps/report/svg_plot.hpp"
#include "apps/report/value_table.hpp"
#include "base/format.hpp"
#include "base/index.hpp"

namespace roadbook {
namespace {

constexpr double kMarginM = 8.0;  // around the driven path: landmarks farther away are cut off
constexpr double kDotCellM = 0.1;

// Further classes of the comparison. Map A has the colour of the first session, B that of the
// second.
constexpr const char* kCompareStyle = R"css(
.map-a{stroke:var(--s0)}.map-b{stroke:var(--s1);stroke-width:1.4;stroke-dasharray:6 3}
.only-a{stroke:var(--s0);opacity:.55}.only-b{stroke:var(--s1);opacity:.55}
.moved{stroke:var(--bad);stroke-width:1.4;fill:none}.worst{stroke:var(--bad)}
)css";

std::string cell_m(const std::optional<double>& value) {
  return value ? fixed(100.0 * *value, 1) + " cm" : "-";
}

std::string compare_tile(const std::string& value, const std::string& name) {
  return "<div class=\"tile\"><b>" + escaped(value) + "</b><span>" + escaped(name) +
         "</span></div>\n";
}

const ComparedPose* worst_pose(const FileComparison& c) {
  return c.maps.worst ? &c.maps.poses[*c.maps.worst] : nullptr;
}

std::string compare_tiles(const FileComparison& c) {
  const ComparedPose* worst = worst_pose(c);
  std::string html = "<div class=\"tiles\">";
  html += compare_tile(std::to_string(c.maps.poses.size()), "poses in both maps");
  html += compare_tile(cell_m(c.maps.median_m), "apart, median");
  html += compare_tile(cell_m(c.maps.p95_m), "apart, 95 %");
  html += compare_tile(worst != nullptr ? cell_m(worst->distance_m) : "-", "apart, worst place");
  html += compare_tile(std::to_string(c.maps.landmarks.only_a), "landmarks only in A");
  html += compare_tile(std::to_string(c.maps.landmarks.only_b), "landmarks only in B");
  html += compare_tile(
      std::to_string(c.maps.landmarks.moved) + " / " + std::to_string(c.maps.landmarks.judged),
      "landmarks moved / judged");
  return html + "</div>\n";
}

// One dot of each cell: maps have many landmarks.
std::vector<Eigen::Vector2d> thinned(const std::vector<Eigen::Vector2d>& points) {
  std::set<std::pair<long, long>> taken;
  std::vector<Eigen::Vector2d> kept;
  for (const Eigen::Vector2d& p : points)
    if (taken.emplace(std::lround(p.x() / kDotCellM), std::lround(p.y() / kDotCellM)).second)
      kept.push_back(p);
  return kept;
}

std::vector<Eigen::Vector2d> seen_from_above(const Map& map,
                                             const std::vector<int>& landmarks,
                                             const Eigen::Isometry3d& T) {
  std::vector<Eigen::Vector2d> points;
  for (const int landmark : landmarks)
    points.emplace_back((T * map.p_map(map.landmarks[at(landmark)])).head<2>());
  return thinned(points);
}

// The driven lines of a map, cut at gaps.
std::vector<std::vector<Eigen::Vector2d>> driven_lines(const Map& map, const Eigen::Isometry3d& T) {
  std::vector<std::vector<Eigen::Vector2d>> lines;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    const bool is_first = k == 0 || map.keyframes[k].after_gap ||
                          map.keyframes[k].session != map.keyframes[k - 1].session;
    if (is_first) lines.emplace_back();
    lines.back().emplace_back((T * map.T_map_vehicle(static_cast<int>(k))).translation().head<2>());
  }
  return lines;
}

void mark_worst(const FileComparison& c, PlanPlot& plot) {
  const ComparedPose* worst = worst_pose(c);
  if (worst == nullptr) return;
  const Eigen::Vector2d place = c.a.T_map_vehicle(worst->a).translation().head<2>();
  plot.dots({place}, 5.0, "worst");
  plot.label(place, "worst: " + cell_m(worst->distance_m), "note");
}

std::string compare_plan(const FileComparison& c) {
  const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();
  const auto lines_a = driven_lines(c.a, identity);
  std::vector<std::vector<Eigen::Vector2d>> lines_b;
  if (c.maps.T_a_b) lines_b = driven_lines(c.b, *c.maps.T_a_b);
  std::vector<Eigen::Vector2d> all;
  for (const auto& line : lines_a) all.insert(all.end(), line.begin(), line.end());
  for (const auto& line : lines_b) all.insert(all.end(), line.begin(), line.end());
  PlanBounds bounds = PlanBounds::around(all);
  bounds.low.array() -= kMarginM;
  bounds.high.array() += kMarginM;
  PlanPlot plot(bounds);
  std::string caption = html_key("track map-a", "A, driven") + html_key("only-a", "landmark of A");
  if (c.maps.T_a_b) {
    plot.dots(seen_from_above(c.a, c.maps.landmarks.ids_only_a, identity), 1.2, "only-a");
    plot.dots(seen_from_above(c.b, c.maps.landmarks.ids_only_b, *c.maps.T_a_b), 1.2, "only-b");
    std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> moved;
    for (const auto& [a, b] : c.maps.landmarks.moved_ids)
      moved.emplace_back(c.a.p_map(c.a.landmarks[at(a)]).head<2>(),
                         (*c.maps.T_a_b * c.b.p_map(c.b.landmarks[at(b)])).head<2>());
    plot.segments(moved, "moved");
    caption = html_key("track map-a", "A, driven") + html_key("track map-b", "B, driven") +
              html_key("only-a", "landmark only in A") + html_key("only-b", "landmark only in B") +
              html_key("moved", "landmark moved, from A to B");
  }
  for (const auto& line : lines_a) plot.polyline(line, "track map-a");
  for (const auto& line : lines_b) plot.polyline(line, "track map-b");
  mark_worst(c, plot);
  std::string html = html_figure(plot.svg("both maps from above"), caption);
  if (!c.maps.T_a_b)
    html += "<p>No pose is in both maps. Their places are not compared, so only A is shown.</p>";
  return html_section("Both maps from above", html);
}

// Distance of the common poses along the way of A.
std::string distance_figures(const FileComparison& c) {
  if (c.maps.poses.empty()) return "";
  std::string html = "<div class=\"pair\">";
  for (std::size_t s = 0; s < c.a.sessions.size(); ++s) {
    std::vector<Eigen::Vector2d> line;
    for (const ComparedPose& pose : c.maps.poses) {
      const Keyframe& keyframe = c.a.keyframes[at(pose.a)];
      if (at(keyframe.session) == s)
        line.emplace_back(keyframe.travelled_m, 100.0 * pose.distance_m);
    }
    if (!line.empty())
      html += html_figure(line_chart_svg(line, "driven [m]", "apart [cm]"),
                          escaped(c.a.sessions[s].name) + ".");
  }
  return html_section("How far apart, along each drive", html + "</div>");
}

std::string share_cell(const std::optional<double>& share) {
  return share ? fixed(100.0 * *share, 1) + " %" : "-";
}

HtmlRow counts_row(const std::string& name, const CommonCounts& counts, const std::string& moved) {
  return {name, std::to_string(counts.both), std::to_string(counts.only_a),
          std::to_string(counts.only_b), moved};
}

std::string counts_section(const FileComparison& c) {
  const auto& maps = c.maps;
  CommonCounts sessions;
  sessions.both = maps.common_sessions.size();
  sessions.only_a = maps.sessions_only_a.size();
  sessions.only_b = maps.sessions_only_b.size();
  std::string html = html_table({"", "in both", "only in A", "only in B", "moved / compared"},
                                {counts_row("sessions", sessions, "-"),
                                 counts_row("landmarks", maps.landmarks,
                                            std::to_string(maps.landmarks.moved) + " / " +
                                                std::to_string(maps.landmarks.judged)),
                                 counts_row("loops", maps.loops, "-"),
                                 counts_row("labels", c.labels,
                                            std::to_string(c.labels.moved.size()) + " / " +
                                                std::to_string(c.labels.compared))});
  html += "<p>Lanes: " + fixed(c.lanes.length_a_m, 1) + " m in A, " + share_cell(c.lanes.share_a) +
          " of them near a lane of B; " + fixed(c.lanes.length_b_m, 1) + " m in B, " +
          share_cell(c.lanes.share_b) + " of them near a lane of A.</p>";
  return html_section("What is in both", html);
}

void add_names(const std::vector<std::string>& names,
               const std::string& where,
               std::vector<HtmlRow>& rows) {
  for (const std::string& name : names) rows.push_back({name, where});
}

std::string names_section(const FileComparison& c) {
  std::vector<HtmlRow> sessions;
  add_names(c.maps.common_sessions, "in both", sessions);
  add_names(c.maps.sessions_only_a, "only in A", sessions);
  add_names(c.maps.sessions_only_b, "only in B", sessions);
  std::vector<HtmlRow> layers;
  for (const CommonLayer& layer : c.layers.both)
    layers.push_back({layer.name, layer.same ? "same" : "changed"});
  add_names(c.layers.only_a, "only in A", layers);
  add_names(c.layers.only_b, "only in B", layers);
  return html_section("Sessions", html_table({"session", ""}, sessions)) +
         html_section("Layers and tables", html_table({"layer", ""}, layers));
}

std::string value_sections(const FileComparison& c) {
  std::string html;
  if (!c.value_a.empty()) html += html_section("Sessions of A", value_table(c.a, c.value_a));
  if (!c.value_b.empty()) html += html_section("Sessions of B", value_table(c.b, c.value_b));
  return html;
}

}  // namespace

std::string compare_page(const FileComparison& comparison,
                         const std::filesystem::path& a,
                         const std::filesystem::path& b) {
  const std::string title = "A: " + a.filename().string() + ", B: " + b.filename().string();
  return "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         escaped(title) + " - roadbook compare</title>\n<style>" + std::string(kPageStyle) +
         std::string(kCompareStyle) +
         "</style></head><body><main>\n<header><p>roadbook compare</p><h1>" + escaped(title) +
         "</h1></header>\n" + compare_tiles(comparison) + compare_plan(comparison) +
         distance_figures(comparison) + counts_section(comparison) + value_sections(comparison) +
         names_section(comparison) + "</main></body></html>\n";
}

}  // namespace roadbook
