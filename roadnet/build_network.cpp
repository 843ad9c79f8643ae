#include "roadnet/build_network.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "roadnet/lane_ids.hpp"
#include "roadnet/network_of_lines.hpp"
#include "roadnet/repeated_parts.hpp"
#include "roadnet/samples.hpp"
#include "roadnet/sparse_tracks.hpp"
#include "roadnet/uncovered.hpp"

namespace roadbook {
namespace {

constexpr double kScatters = 7.0;       // reach in scatters: both sides of 3.5 sigma
constexpr double kFullCoverage = 0.99;  // below: what is missing is named

double choose_reach(const std::vector<DrivenPass>& passes, const RoadNetworkOptions& options) {
  if (options.reach_m > 0.0) return options.reach_m;
  return std::clamp(kScatters * lateral_scatter(passes), options.min_reach_m, options.max_reach_m);
}

// The network of passes whose positions are close together, cut where they are not.
LineNetwork network_of_dense_tracks(const std::vector<DrivenPass>& driven,
                                    const RoadNetworkOptions& options,
                                    double reach_m,
                                    RoadNetworkStages* stages) {
  std::vector<DrivenPass> lines = cut_at_gaps(driven, options.max_gap_m);
  const double share_kept =
      std::min(1.0, driven_length(lines) / std::max(driven_length(driven), 1e-9));
  LineNetwork made = network_of_lines(std::move(lines), options,
                                      {.reach_m = reach_m, .share_kept = share_kept}, stages);
  made.max_gap_m = options.max_gap_m;
  return made;
}

}  // namespace

RoadNetwork build_road_network(const std::vector<DrivenPass>& driven,
                               const RoadNetworkOptions& options,
                               const RoadNetwork* previous,
                               RoadNetworkStages* stages) {
  options.check();
  check_passes(driven);
  const double reach_m = choose_reach(driven, options);
  LineNetwork made = is_sparse(driven, options, reach_m)
                         ? network_of_sparse_tracks(driven, options, reach_m, stages)
                         : network_of_dense_tracks(driven, options, reach_m, stages);
  RoadNetwork& network = made.network;
  if (network.lanes.empty()) {
    network.status = RoadNetworkStatus::kEmpty;
  } else if (network.coverage < options.min_coverage) {
    network.status = RoadNetworkStatus::kLowCoverage;
  }
  if (network.coverage < kFullCoverage) {
    for (DrivenPass& gap : gaps(driven, made.max_gap_m)) made.lines.push_back(std::move(gap));
    network.uncovered = uncovered_stretches(network, made.lines, options.vertical_limit_m);
  }
  assign_stable_ids(network, previous);
  return std::move(made.network);
}

}  // namespace roadbook
