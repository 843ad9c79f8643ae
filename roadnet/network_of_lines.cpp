#include "roadnet/network_of_lines.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "roadnet/attract_tracks.hpp"
#include "roadnet/cover.hpp"
#include "roadnet/lane_centre.hpp"
#include "roadnet/lane_passes.hpp"
#include "roadnet/prune.hpp"
#include "roadnet/repeated_parts.hpp"
#include "roadnet/samples.hpp"
#include "roadnet/simplify.hpp"

namespace roadbook {
namespace {

constexpr double kPointsAReach = 4.0;
constexpr double kOneRoad = 0.5;  // cells of this many reaches: passes up to one reach apart

double polyline_length(const std::vector<Eigen::Vector3d>& line) {
  double length = 0.0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) length += (line[i + 1] - line[i]).norm();
  return length;
}

/// How much of the driven length is left, at most all: resampling changes a little.
double length_ratio(const std::vector<DrivenPass>& kept, const std::vector<DrivenPass>& of) {
  return std::min(1.0, driven_length(kept) / std::max(driven_length(of), 1e-9));
}

RoadNetwork network_of(const LaneCurves& curves, const NetworkUse& use, double z_scale) {
  RoadNetwork network;
  const Eigen::Vector3d unscale(1.0, 1.0, 1.0 / z_scale);
  std::vector<int> intersection(curves.points.positions.size(), -1);
  for (int i = 0; i < curves.points.size(); ++i) {
    if (curves.points.degree(i) < 3) continue;
    intersection[static_cast<std::size_t>(i)] = static_cast<int>(network.intersections.size());
    network.intersections.push_back(
        {0, curves.points.positions[static_cast<std::size_t>(i)].cwiseProduct(unscale)});
  }
  for (std::size_t l = 0; l < curves.lanes.size(); ++l) {
    Lane lane;
    for (const int node : curves.lanes[l].nodes) {
      lane.centre.push_back(
          curves.points.positions[static_cast<std::size_t>(node)].cwiseProduct(unscale));
    }
    lane.from_intersection = intersection[static_cast<std::size_t>(curves.lanes[l].nodes.front())];
    lane.to_intersection = intersection[static_cast<std::size_t>(curves.lanes[l].nodes.back())];
    lane.closed = curves.lanes[l].closed;
    lane.forward_passes = use.lanes[l].forward;
    lane.backward_passes = use.lanes[l].backward;
    lane.reverse_gear_passes = use.lanes[l].reverse_gear;
    lane.length_m = polyline_length(lane.centre);
    lane.width_m = 4.0 * std::sqrt(use.lanes[l].lateral_variance);
    network.length_m += lane.length_m;
    network.lanes.push_back(std::move(lane));
  }
  network.coverage = use.coverage;
  network.cycle_rank = cycle_rank(curves.points);
  network.components = component_count(curves.points);
  return network;
}

}  // namespace

double driven_length(const std::vector<DrivenPass>& passes) {
  double length = 0.0;
  for (const DrivenPass& pass : passes) length += polyline_length(pass.positions);
  return length;
}

LineNetwork network_of_lines(std::vector<DrivenPass> lines,
                             const RoadNetworkOptions& options,
                             const LineNetworkOptions& own,
                             RoadNetworkStages* stages) {
  const double reach_m = own.reach_m;
  const double step_m = reach_m / own.samples_a_reach;
  if (options.attraction_m > 0.0)
    lines = attract_passes(
        lines,
        {.step_m = step_m, .width_m = options.attraction_m, .floor_m = options.vertical_limit_m});
  const std::vector<DrivenPass> passes = repeated_parts(
      lines, {.step_m = step_m, .radius_m = kOneRoad * reach_m, .min_passes = options.min_passes});
  const double share_kept = own.share_kept * length_ratio(passes, lines);
  // Heights are stretched so that one reach is the vertical limit: floors are then far apart.
  const double z_scale = reach_m / options.vertical_limit_m;
  std::vector<PassSamples> samples;
  for (const DrivenPass& pass : passes) samples.push_back(resample(pass, step_m, z_scale));

  RoadGraph skeleton = cover_graph(samples, reach_m);
  RoadNetworkStages parts;
  if (stages != nullptr) {
    parts.full = skeleton;
    parts.one_loop = skeleton;
    prune_once(parts.one_loop, SpurRule::kKeep);
  }
  remove_isolated(skeleton);
  simplify(skeleton, samples, reach_m);
  while (remove_short_dead_ends(skeleton, own.min_dead_end_m)) simplify(skeleton, samples, reach_m);

  parts.lanes = trace_lanes(skeleton);
  LaneCurves curves = densify(skeleton, parts.lanes, reach_m / kPointsAReach);
  fit_centres(curves, samples, reach_m);
  const NetworkUse use = measure_use(curves, passes, samples, reach_m);

  LineNetwork result{network_of(curves, use, z_scale), std::move(lines)};
  result.network.reach_m = reach_m;
  // What was left out counts as off the network: the share kept is never better than it was driven.
  result.network.coverage *= share_kept;
  if (stages != nullptr) {
    parts.finished = std::move(skeleton);
    for (RoadGraph* graph : {&parts.full, &parts.one_loop, &parts.finished})
      for (Eigen::Vector3d& position : graph->positions) position.z() /= z_scale;
    *stages = std::move(parts);
  }
  return result;
}

}  // namespace roadbook
