#include "roadnet/sparse_tracks.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "roadnet/match_passes.hpp"
#include "roadnet/repeated_parts.hpp"
#include "roadnet/way_graph.hpp"

namespace roadbook {
namespace {

constexpr double kSparse = 3.0;         // reaches
constexpr double kMostSteps = 0.9;      // of all: the longest ones may be gaps
constexpr double kGap = 5.0;            // typical steps
constexpr double kStanding = 1.0;       // reaches: a vehicle that stands, or creeps
constexpr int kMinPasses = 3;           // fewer passes with sparse positions do not show a street
constexpr double kErringPasses = 0.05;  // share of passes that may err in the same place
constexpr double kSamplesAReach = 4.0;
constexpr double kMinDeadEnd = 4.0;     // reaches
constexpr double kNoiseOfReach = 0.75;  // before it is measured, and at least
constexpr double kReachOfNoise = 1.2;
constexpr double kCoarse = 1.5;
constexpr int kRounds = 4;
constexpr double kSame = 0.01;  // a network whose length and coverage change less is finished

// Positions while standing are one position: their mean. They would draw a star of ways otherwise.
std::vector<DrivenPass> join_standing(std::vector<DrivenPass> passes, double radius_m) {
  for (DrivenPass& pass : passes) {
    std::vector<Eigen::Vector3d> kept;
    for (std::size_t i = 0; i < pass.positions.size();) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      std::size_t end = i;
      for (; end < pass.positions.size() &&
             (pass.positions[end] - pass.positions[i]).norm() < radius_m;
           ++end)
        sum += pass.positions[end];
      kept.emplace_back(sum / static_cast<double>(end - i));
      i = end;
    }
    pass.positions = std::move(kept);
  }
  return passes;
}

// Standard deviation of normal errors from the median of their sizes; 0: none.
double standard_deviation(std::vector<double> sizes) {
  if (sizes.empty()) return 0.0;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return *middle / 0.6745;
}

bool is_same(const RoadNetwork& a, const RoadNetwork& b) {
  return std::abs(a.length_m - b.length_m) <= kSame * std::max(a.length_m, b.length_m) &&
         std::abs(a.coverage - b.coverage) <= kSame;
}

// Errors of many passes meet in the same place more often than errors of few.
int least_passes(const RoadNetwork& found, double driven_m) {
  const double passes = driven_m / std::max(found.length_m, 1.0);
  return std::max(kMinPasses, static_cast<int>(std::lround(kErringPasses * passes)));
}

TrackScales scales_of(double reach_m, double noise_m) {
  return {reach_m, std::max(kNoiseOfReach * reach_m, noise_m)};
}

MatchedPasses match(const std::vector<DrivenPass>& tracks,
                    const RoadNetwork* found,
                    const TrackScales& scales) {
  return match_passes(tracks, way_graph(tracks, found, scales), scales);
}

// How a network is built of matched passes.
struct Lines {
  RoadNetworkOptions options;
  double reach_m = 0.0;  // that the options are for
  TrackScales scales;

  [[nodiscard]] LineNetwork network(MatchedPasses matched,
                                    int min_passes,
                                    double share_kept,
                                    RoadNetworkStages* stages) const {
    RoadNetworkOptions own = options;
    own.min_passes = std::min(options.min_passes, min_passes);
    own.attraction_m *= scales.reach_m / reach_m;
    return network_of_lines(std::move(matched.passes), own,
                            {.reach_m = scales.reach_m,
                             .samples_a_reach = kSamplesAReach,
                             .share_kept = share_kept,
                             .min_dead_end_m = kMinDeadEnd * scales.reach_m},
                            stages);
  }
};

// Standard deviation of the positions across a first, coarse network: one as fine as the result may
// have two lanes in the noise of one road, and hide the noise.
double measured_noise(const std::vector<DrivenPass>& tracks,
                      const RoadNetworkOptions& options,
                      double reach_m) {
  const TrackScales coarse = scales_of(kCoarse * reach_m, 0.0);
  const LineNetwork made = Lines{options, reach_m, coarse}.network(match(tracks, nullptr, coarse),
                                                                   kMinPasses, 1.0, nullptr);
  return standard_deviation(match(tracks, &made.network, coarse).offsets_m);
}

}  // namespace

double typical_step(const std::vector<DrivenPass>& passes) {
  std::vector<double> steps;
  for (const DrivenPass& pass : passes)
    for (std::size_t i = 0; i + 1 < pass.positions.size(); ++i)
      steps.push_back((pass.positions[i + 1] - pass.positions[i]).norm());
  if (steps.empty()) return 0.0;
  std::sort(steps.begin(), steps.end());
  const auto most_steps = static_cast<std::size_t>(kMostSteps * static_cast<double>(steps.size()));
  steps.resize(std::max<std::size_t>(1, most_steps));
  double all = 0.0;
  for (const double step : steps) all += step;
  double below = 0.0;
  for (const double step : steps) {
    below += step;
    if (below >= 0.5 * all) return step;
  }
  return 0.0;
}

bool is_sparse(const std::vector<DrivenPass>& passes,
               const RoadNetworkOptions& options,
               double reach_m) {
  return options.attraction_m > 0.0 && typical_step(passes) > kSparse * reach_m;
}

LineNetwork network_of_sparse_tracks(const std::vector<DrivenPass>& driven,
                                     const RoadNetworkOptions& options,
                                     double reach_m,
                                     RoadNetworkStages* stages) {
  const double max_gap_m = std::max(options.max_gap_m, kGap * typical_step(driven));
  const std::vector<DrivenPass> uncut = join_standing(driven, kStanding * reach_m);
  const std::vector<DrivenPass> tracks = cut_at_gaps(uncut, max_gap_m);
  const double share_kept =
      std::min(1.0, driven_length(tracks) / std::max(driven_length(uncut), 1e-9));
  const double noise_m = measured_noise(tracks, options, reach_m);
  const TrackScales scales = scales_of(std::max(reach_m, kReachOfNoise * noise_m), noise_m);
  const Lines lines{options, reach_m, scales};
  LineNetwork made = lines.network(match(tracks, nullptr, scales), kMinPasses, share_kept, stages);
  for (int round = 1; round < kRounds; ++round) {
    const RoadNetwork before = std::move(made.network);
    made = lines.network(match(tracks, &before, scales),
                         least_passes(before, driven_length(tracks)), share_kept, stages);
    if (is_same(before, made.network)) break;
  }
  made.max_gap_m = max_gap_m;
  return made;
}

}  // namespace roadbook
