#include "exchange/path_conditions.hpp"

#include <algorithm>
#include <cmath>

namespace roadbook {
namespace {

// The profile at rows whose distances differ: made at equal steps, each of them limited by all rows
// within a step of it, so that no row in between is passed too fast.
std::vector<double> followed_speeds(const std::vector<LaneSpeed>& rows,
                                    const LaneSpeedOptions& options) {
  const double length = rows.back().s_m - rows.front().s_m;
  const int steps = std::max(2, static_cast<int>(std::ceil(length / options.step_m)));
  const double step = length / steps;
  std::vector<LaneSpeed> even(static_cast<std::size_t>(steps) + 1);
  for (LaneSpeed& place : even) place.speed = place.grip_acceleration = INFINITY;
  const auto place_of = [&](const LaneSpeed& row) { return (row.s_m - rows.front().s_m) / step; };
  const auto limit = [&](int k, const LaneSpeed& row) {
    if (k < 0 || k > steps) return;
    LaneSpeed& place = even[static_cast<std::size_t>(k)];
    place.speed = std::min(place.speed, row.speed);
    place.grip_acceleration = std::min(place.grip_acceleration, row.grip_acceleration);
  };
  for (const LaneSpeed& row : rows)
    for (int k = static_cast<int>(std::floor(place_of(row) - 1e-9)), end = k + 2; k <= end; ++k)
      limit(k, row);
  // Steps finer than the rows: between two rows the lower one counts.
  for (std::size_t i = 0; i + 1 < rows.size(); ++i)
    for (int k = static_cast<int>(place_of(rows[i])); k <= static_cast<int>(place_of(rows[i + 1]));
         ++k) {
      limit(k, rows[i]);
      limit(k, rows[i + 1]);
    }
  make_feasible(even, step, false, options);
  std::vector<double> speeds;
  for (const LaneSpeed& row : rows) {
    const double at = std::clamp(place_of(row), 0.0, static_cast<double>(steps));
    const auto k = std::min(static_cast<std::size_t>(at), even.size() - 2);
    const double part = at - static_cast<double>(k);
    speeds.push_back(even[k].speed + part * (even[k + 1].speed - even[k].speed));
  }
  return speeds;
}

}  // namespace

PathConditions::PathConditions(const std::filesystem::path& map,
                               const StoredPaths& stored,
                               const std::vector<std::vector<RoutePoint>>& tables,
                               bool route) {
  const MapLayers layers(map);
  speeds_ = read_speed_layers(layers);
  friction_ = read_friction_layers(layers, stored.paths);
  for (const std::vector<RoutePoint>& rows : tables) {
    std::vector<PathCondition> conditions(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      set_friction(rows[i], conditions[i]);
      set_lane_speed(rows[i], conditions[i]);
    }
    if (route) set_route_speeds(rows, conditions);
    tables_.push_back(std::move(conditions));
  }
}

std::string PathConditions::speed_date() const {
  return speeds_ ? utc_text(speeds_->date_ns) : "none";
}

std::string PathConditions::friction_date() const {
  return friction_ ? utc_text(friction_->date_ns) : "none";
}

double PathConditions::speed_coverage() const { return speeds_ ? speeds_->coverage() : 0.0; }

const LaneProfile* PathConditions::profile_of(std::uint64_t lane) const {
  if (speeds_)
    for (const LaneProfile& profile : speeds_->profiles)
      if (profile.lane == lane) return &profile;
  return nullptr;
}

void PathConditions::set_friction(const RoutePoint& row, PathCondition& at) const {
  if (!friction_) return;
  std::vector<PathPlace> places;
  friction_->strips.places_of(row.at.position, places);
  double nearest = INFINITY;
  for (const PathPlace& place : places) {
    const auto moments = friction_->map.moments(0, place);
    if (!moments || !(std::abs(place.e_m) < nearest)) continue;
    nearest = std::abs(place.e_m);
    at.friction = moments->mean;
    at.friction_sigma = std::sqrt(moments->variance);
  }
}

void PathConditions::set_lane_speed(const RoutePoint& row, PathCondition& at) const {
  const LaneProfile* const profile = profile_of(row.lane);
  if (profile == nullptr) return;
  at.speed_limit = profile->places.front().limit;
  at.speed = profile->speed_at(row.s_m);
}

void PathConditions::set_route_speeds(const std::vector<RoutePoint>& rows,
                                      std::vector<PathCondition>& conditions) const {
  if (!speeds_ || rows.size() < 2) return;
  std::vector<WayPoint> way;
  std::vector<double> s;
  for (const RoutePoint& row : rows) {
    way.push_back({row.at.position, row.at.left(), row.at.curvature});
    s.push_back(row.s_m);
  }
  FrictionAt friction;
  std::vector<PathPlace> places_of_point;
  if (friction_)
    friction = [&](double at_m, double e_m) -> std::optional<PropertyMoments> {
      const auto i =
          static_cast<std::size_t>(std::lower_bound(s.begin(), s.end(), at_m) - s.begin());
      friction_->strips.places_of(way[i].position + e_m * way[i].left, places_of_point);
      std::optional<PropertyMoments> lowest;
      for (const PathPlace& place : places_of_point)
        if (const auto moments = friction_->map.moments(0, place);
            moments && (!lowest || moments->mean < lowest->mean))
          lowest = moments;
      return lowest;
    };
  auto places = speed_limits_along(way, s, speeds_->options.max_speed, presence_of(*speeds_),
                                   friction, speeds_->options);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (std::isfinite(conditions[i].speed_limit)) places[i].limit = conditions[i].speed_limit;
    places[i].speed = places[i].ceiling();
  }
  const std::vector<double> speeds = followed_speeds(places, speeds_->options);
  for (std::size_t i = 0; i < places.size(); ++i) conditions[i].speed = speeds[i];
}

}  // namespace roadbook
