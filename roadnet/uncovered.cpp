#include "roadnet/uncovered.hpp"

#include <algorithm>
#include <cstddef>

#include "roadnet/samples.hpp"
#include "roadnet/spatial_hash.hpp"

namespace roadbook {
namespace {

constexpr double kLanePoints = 0.25;  // reaches between the points that stand for a lane
constexpr double kStep = 0.5;         // reaches between samples
constexpr double kOneStretch = 2.0;   // reaches: nearer to each other is one stretch

using Part = std::vector<Eigen::Vector3d>;  // samples of one pass, one after the other

SpatialHash points_of_lanes(const RoadNetwork& network, double z_scale) {
  SpatialHash points(network.reach_m);
  for (const Lane& lane : network.lanes)
    for (const auto& point :
         resample({0, false, lane.centre}, kLanePoints * network.reach_m, z_scale).points)
      points.insert(point);
  return points;
}

std::vector<Part> missed_parts(const RoadNetwork& network,
                               const std::vector<DrivenPass>& driven,
                               double z_scale) {
  const SpatialHash lanes = points_of_lanes(network, z_scale);
  std::vector<Part> parts;
  for (const DrivenPass& pass : driven) {
    bool open = false;
    for (const auto& sample : resample(pass, kStep * network.reach_m, z_scale).points) {
      const bool missed = lanes.nearest(sample, network.reach_m) < 0;
      if (missed && !open) parts.emplace_back();
      if (missed) parts.back().push_back(sample);
      open = missed;
    }
  }
  std::stable_sort(parts.begin(), parts.end(),
                   [](const Part& a, const Part& b) { return a.size() > b.size(); });
  return parts;
}

}  // namespace

std::vector<UncoveredStretch> uncovered_stretches(const RoadNetwork& network,
                                                  const std::vector<DrivenPass>& driven,
                                                  double vertical_limit_m) {
  const double z_scale = network.reach_m / vertical_limit_m;
  const double step_m = kStep * network.reach_m;
  std::vector<UncoveredStretch> stretches;
  SpatialHash known(kOneStretch * network.reach_m);
  std::vector<std::size_t> stretch_of;
  for (const Part& part : missed_parts(network, driven, z_scale)) {
    Part fresh;
    std::vector<std::size_t> joined;
    for (const Eigen::Vector3d& sample : part) {
      const int at = known.nearest(sample, kOneStretch * network.reach_m);
      if (at < 0) {
        fresh.push_back(sample);
        continue;
      }
      joined.push_back(stretch_of[static_cast<std::size_t>(at)]);
      stretches[joined.back()].driven_m += step_m;
    }
    if (!fresh.empty()) {
      for (const Eigen::Vector3d& sample : fresh) {
        known.insert(sample);
        stretch_of.push_back(stretches.size());
      }
      joined.push_back(stretches.size());
      stretches.push_back(
          {fresh.front(), fresh.back(), step_m * static_cast<double>(fresh.size()), 0});
    }
    std::sort(joined.begin(), joined.end());
    joined.erase(std::unique(joined.begin(), joined.end()), joined.end());
    for (const std::size_t stretch : joined) ++stretches[stretch].parts;
  }
  for (UncoveredStretch& stretch : stretches) {
    stretch.from.z() /= z_scale;
    stretch.to.z() /= z_scale;
  }
  std::stable_sort(stretches.begin(), stretches.end(),
                   [](const auto& a, const auto& b) { return a.driven_m > b.driven_m; });
  return stretches;
}

}  // namespace roadbook
