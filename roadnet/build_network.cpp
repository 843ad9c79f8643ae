#include "roadnet/build_network.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/require_option.hpp"
#include "roadnet/cover.hpp"
#include "roadnet/draw_together.hpp"
#include "roadnet/lane_centre.hpp"
#include "roadnet/lane_ids.hpp"
#include "roadnet/lane_passes.hpp"
#include "roadnet/prune.hpp"
#include "roadnet/repeated_parts.hpp"
#include "roadnet/samples.hpp"
#include "roadnet/simplify.hpp"

namespace roadbook {
namespace {

constexpr double kScatters = 7.0;       // reach in scatters: both sides of 3.5 sigma
constexpr double kSamplesAReach = 8.0;  // the cover must not skip a place between two samples
constexpr double kPointsAReach = 4.0;
constexpr double kOneRoad = 0.5;  // cells of this many reaches: passes up to one reach apart

double choose_reach(const std::vector<DrivenPass>& passes, const RoadNetworkOptions& options) {
  if (options.reach_m > 0.0) return options.reach_m;
  return std::clamp(kScatters * lateral_scatter(passes), options.min_reach_m, options.max_reach_m);
}

double polyline_length(const std::vector<Eigen::Vector3d>& line) {
  double length = 0.0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) length += (line[i + 1] - line[i]).norm();
  return length;
}

double driven_length(const std::vector<DrivenPass>& passes) {
  double length = 0.0;
  for (const DrivenPass& pass : passes) length += polyline_length(pass.positions);
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

void RoadNetworkOptions::check() const {
  const auto finite_positive = [](double value) { return std::isfinite(value) && value > 0.0; };
  require_option(std::isfinite(reach_m) && reach_m >= 0.0, "reach_m", reach_m, "0 or more");
  require_option(finite_positive(min_reach_m), "min_reach_m", min_reach_m, "more than 0");
  require_option(std::isfinite(max_reach_m) && max_reach_m >= min_reach_m, "max_reach_m",
                 max_reach_m, "min_reach_m or more");
  require_option(finite_positive(vertical_limit_m), "vertical_limit_m", vertical_limit_m,
                 "more than 0");
  require_option(min_coverage >= 0.0 && min_coverage <= 1.0, "min_coverage", min_coverage,
                 "0 to 1");
  require_option(std::isfinite(max_gap_m) && max_gap_m >= 0.0, "max_gap_m", max_gap_m, "0 or more");
  require_option(std::isfinite(attraction_m) && attraction_m >= 0.0, "attraction_m", attraction_m,
                 "0 or more");
  require_option(min_passes >= 1, "min_passes", min_passes, "1 or more");
}

RoadNetworkOptions RoadNetworkOptions::for_gps() {
  RoadNetworkOptions options;
  options.reach_m = 16.0;
  options.min_passes = 5;
  options.attraction_m = 12.0;
  options.max_gap_m = 100.0;
  options.min_coverage = 0.95;
  return options;
}

RoadNetwork build_road_network(const std::vector<DrivenPass>& driven,
                               const RoadNetworkOptions& options,
                               const RoadNetwork* previous,
                               RoadNetworkStages* stages) {
  options.check();
  check_passes(driven);
  const double reach_m = choose_reach(driven, options);
  std::vector<DrivenPass> all = cut_at_gaps(driven, options.max_gap_m);
  double share_kept = length_ratio(all, driven);
  if (options.attraction_m > 0.0)
    all = draw_together(all, {.step_m = reach_m / kSamplesAReach,
                              .width_m = options.attraction_m,
                              .floor_m = options.vertical_limit_m});
  const std::vector<DrivenPass> passes = repeated_parts(all, {.step_m = reach_m / kSamplesAReach,
                                                              .radius_m = kOneRoad * reach_m,
                                                              .min_passes = options.min_passes});
  share_kept *= length_ratio(passes, all);
  // Heights are stretched so that one reach is the vertical limit: floors are then far apart.
  const double z_scale = reach_m / options.vertical_limit_m;
  std::vector<PassSamples> samples;
  for (const DrivenPass& pass : passes) {
    samples.push_back(resample(pass, reach_m / kSamplesAReach, z_scale));
  }

  RoadGraph skeleton = cover_graph(samples, reach_m);
  RoadNetworkStages own;
  own.full = skeleton;
  own.one_loop = skeleton;
  if (stages != nullptr) prune_once(own.one_loop, SpurRule::kKeep);
  remove_isolated(skeleton);
  simplify(skeleton, samples, reach_m);

  own.lanes = trace_lanes(skeleton);
  LaneCurves curves = densify(skeleton, own.lanes, reach_m / kPointsAReach);
  fit_centres(curves, samples, reach_m);
  const NetworkUse use = measure_use(curves, passes, samples, reach_m);

  RoadNetwork network = network_of(curves, use, z_scale);
  network.reach_m = reach_m;
  // What was left out counts as off the network: the share kept is never better than it was driven.
  network.coverage *= share_kept;
  if (network.lanes.empty()) {
    network.status = RoadNetworkStatus::kEmpty;
  } else if (network.coverage < options.min_coverage) {
    network.status = RoadNetworkStatus::kLowCoverage;
  }
  name_parts(network, previous);
  if (stages != nullptr) {
    own.finished = skeleton;
    for (RoadGraph* graph : {&own.full, &own.one_loop, &own.finished}) {
      for (Eigen::Vector3d& position : graph->positions) position.z() /= z_scale;
    }
    *stages = std::move(own);
  }
  return network;
}

}  // namespace roadbook
