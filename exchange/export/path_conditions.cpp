#include "exchange/export/path_conditions.hpp"

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

// Least of speeds known at places `s` (straight between them) from `from` to `to`, both ends
// included.
double least_between(const std::vector<double>& s,
                     const std::vector<double>& speeds,
                     double from,
                     double to) {
  const auto at = [&](double place) {
    const auto above = std::lower_bound(s.begin(), s.end(), place) - s.begin();
    const auto i = static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(above, 1, static_cast<std::ptrdiff_t>(s.size()) - 1));
    const double part = std::clamp((place - s[i - 1]) / (s[i] - s[i - 1]), 0.0, 1.0);
    return speeds[i - 1] + part * (speeds[i] - speeds[i - 1]);
  };
  double least = std::min(at(from), at(to));
  for (auto i = static_cast<std::size_t>(std::lower_bound(s.begin(), s.end(), from) - s.begin());
       i < s.size() && s[i] <= to; ++i)
    least = std::min(least, speeds[i]);
  return least;
}

}  // namespace

PathConditions::PathConditions(const std::filesystem::path& map,
                               const StoredPaths& stored,
                               const std::vector<std::vector<RoutePoint>>& tables,
                               const std::vector<RoutePoint>& fine_route) {
  const MapLayers layers(map);
  speeds_ = read_current_speeds(layers, stored.paths);
  friction_ = read_friction_layers(layers, stored.paths);
  for (const std::vector<RoutePoint>& rows : tables) {
    std::vector<PathCondition> conditions(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      set_friction(rows[i], conditions[i]);
      set_lane_speed(rows, i, conditions[i]);
    }
    if (!fine_route.empty()) set_route_speeds(rows, fine_route, conditions);
    tables_.push_back(std::move(conditions));
  }
}

std::optional<std::string> PathConditions::speed_date() const {
  return speeds_ ? std::optional(utc_text(speeds_->date_ns)) : std::nullopt;
}

std::optional<std::string> PathConditions::friction_date() const {
  return friction_ ? std::optional(utc_text(friction_->date_ns)) : std::nullopt;
}

double PathConditions::speed_coverage() const { return speeds_ ? speeds_->coverage() : 0.0; }

double PathConditions::friction_coverage() const {
  if (!friction_) return 0.0;
  const PropertyMap& map = friction_->map;
  std::size_t seen = 0;
  for (std::size_t l = 0; l < map.knots().size(); ++l) seen += map.knot_evidence(l) > 0.0 ? 1U : 0U;
  return static_cast<double>(seen) / static_cast<double>(map.knots().size());
}

std::vector<std::string> PathConditions::further() const {
  std::vector<std::string> names;
  if (friction_)
    for (const PropertyPrior& property : friction_->map.prior().properties)
      names.push_back(property.name);
  if (!names.empty()) names.erase(names.begin());
  return names;
}

const LaneProfile* PathConditions::profile_of(std::uint64_t lane) const {
  if (speeds_)
    for (const LaneProfile& profile : speeds_->profiles)
      if (profile.lane == lane) return &profile;
  return nullptr;
}

double PathConditions::limit_at(const std::vector<RoutePoint>& rows, std::size_t i) const {
  const auto of = [&](const RoutePoint& row) {
    const LaneProfile* const lane = profile_of(row.lane);
    return lane == nullptr ? INFINITY : lane->places.front().limit;
  };
  const double left = of(rows[i]);
  // A turn lies on the ground of the lane entered as well.
  while (i + 1 < rows.size() && rows[i].turn) ++i;
  return std::min(left, of(rows[i]));
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
    at.further.clear();
    for (std::size_t k = 1; k < friction_->map.prior().properties.size(); ++k)
      at.further.push_back(*friction_->map.moments(k, place));
  }
}

void PathConditions::set_lane_speed(const std::vector<RoutePoint>& rows,
                                    std::size_t i,
                                    PathCondition& at) const {
  const RoutePoint& row = rows[i];
  const LaneProfile* const profile = profile_of(row.lane);
  if (profile == nullptr) return;
  at.speed_limit = limit_at(rows, i);
  // A reader goes straight from row to row: as slow as all that lies between the neighbours.
  const double from = i > 0 ? rows[i - 1].s_m : row.s_m;
  const double to = i + 1 < rows.size() ? rows[i + 1].s_m : row.s_m;
  const int steps = static_cast<int>(std::ceil((to - from) / profile->step_m));
  at.speed = profile->speed_at(row.s_m);
  for (int k = 0; k <= steps && steps > 0; ++k)
    at.speed = std::min(at.speed, profile->speed_at(from + (to - from) * k / steps));
}

void PathConditions::set_route_speeds(const std::vector<RoutePoint>& rows,
                                      const std::vector<RoutePoint>& fine,
                                      std::vector<PathCondition>& conditions) const {
  if (!speeds_ || rows.size() < 2 || fine.size() < 2) return;
  std::vector<WayPoint> way;
  std::vector<double> s;
  for (const RoutePoint& row : fine) {
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
    if (const double limit = limit_at(fine, i); std::isfinite(limit)) places[i].limit = limit;
    places[i].speed = places[i].ceiling();
  }
  const std::vector<double> speeds = followed_speeds(places, speeds_->options);
  // A reader goes straight from row to row: each row is as slow as all that lies between it and its
  // neighbours. Lengths of chords differ a little between the tables.
  const double scale = fine.back().s_m / rows.back().s_m;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double from = scale * rows[i > 0 ? i - 1 : i].s_m;
    const double to = scale * rows[std::min(i + 1, rows.size() - 1)].s_m;
    conditions[i].speed = least_between(s, speeds, from, to);
  }
}

}  // namespace roadbook
