#include "speedmap/property_map/lane_strips.hpp"

#include <algorithm>

#include "base/error.hpp"

namespace roadbook {

LaneStrips::LaneStrips(const std::vector<LanePath>& lanes, double spacing_m, double kernel_width_m)
    : width_{kernel_width_m, kernel_width_m} {
  std::vector<PathPlace> places;
  double begin = 0.0;
  for (const LanePath& lane : lanes) {
    if (lane.status == LanePathStatus::kDegenerate || !(lane.tube_m > 0.0)) continue;
    KnotGridOptions grid;
    grid.length_m = lane.length_m;
    // A ring that the kernel would meet itself on stays a strip with two ends.
    grid.closed = lane.path.closed && lane.length_m >= 4.0 * kernel_width_m;
    grid.e_min_m = -lane.tube_m;
    grid.e_max_m = lane.tube_m;
    grid.spacing_s_m = grid.spacing_e_m = spacing_m;
    grid.width = width_;
    if (grid.closed) rings_.push_back({begin, lane.length_m});
    const Knots knots = Knots::grid(grid);
    for (const PathPlace& place : knots.places()) places.push_back({begin + place.s_m, place.e_m});
    strips_.push_back({lane.lane, begin, lane.tube_m,
                       PathFrame(PathCurve(lane.path), Tube{-lane.tube_m, lane.tube_m})});
    begin += lane.length_m + 4.0 * kernel_width_m;
  }
  if (strips_.empty()) throw Refused("error: lanes: got none with a path, want at least one");
  knots_ = knots_at(std::move(places));
}

Knots LaneStrips::knots_at(std::vector<PathPlace> places) const {
  return knots_at(std::move(places), width_);
}

Knots LaneStrips::knots_at(std::vector<PathPlace> places, const KernelWidth& width) const {
  return {std::move(places), width, rings_};
}

const LaneStrips::Strip* LaneStrips::find(std::uint64_t lane) const {
  for (const Strip& strip : strips_)
    if (strip.lane == lane) return &strip;
  return nullptr;
}

void LaneStrips::places_of(const Eigen::Vector2d& p, std::vector<PathPlace>& places) const {
  places.clear();
  for (const Strip& strip : strips_) {
    const PathProjection at = strip.frame.project(p);
    if (at.inside()) places.push_back({strip.begin_m + at.s_m, at.e_m});
  }
}

const LaneStrips::Strip& LaneStrips::strip_of(const PathPlace& place) const {
  const auto after =
      std::upper_bound(strips_.begin(), strips_.end(), place.s_m,
                       [](double s, const Strip& strip) { return s < strip.begin_m; });
  return after == strips_.begin() ? *after : *(after - 1);
}

}  // namespace roadbook
