#include "apps/report/network_section.hpp"

#include "apps/report/html.hpp"
#include "apps/report/svg_plot.hpp"
#include "base/format.hpp"

namespace roadbook {
namespace {

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
  return html_figure(plot.svg(caption), escaped(caption) + ": " + std::to_string(nodes.size()) +
                                            " nodes, " + std::to_string(edges.size()) + " edges.");
}

}  // namespace

std::string network_section(const ReportData& data) {
  if (!data.network) return "";
  const RoadNetwork& network = *data.network;
  const PlanBounds bounds = PlanBounds::around(driven_positions(data.map));
  PlanPlot lanes(bounds, 440.0, 360.0);
  std::vector<HtmlRow> rows;
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
  html += html_figure(lanes.svg("lanes"),
                      "d) Lanes between intersections: " + std::to_string(network.lanes.size()) +
                          " lanes, " + std::to_string(network.intersections.size()) +
                          " intersections.");
  html += "</div><p>" + fixed(network.length_m, 1) + " m of lanes; " +
          fixed(100.0 * network.coverage, 1) + " % of the driven positions lie within " +
          fixed(network.reach_m, 2) + " m of them.</p>";
  html += html_table({"lane", "length [m]", "spread [m]", "direction", "passes", "in reverse gear"},
                     rows);
  return html_section("Road network", html);
}

}  // namespace roadbook
