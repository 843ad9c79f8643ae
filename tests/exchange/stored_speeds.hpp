#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "exchange/layers/friction_layers.hpp"
#include "exchange/layers/speed_layers.hpp"
#include "tests/exchange/driven_place.hpp"

namespace roadbook::test {

inline PropertyMapPrior two_classes() {
  PropertyMapPrior prior;
  prior.classes = {"dry", "wet"};
  prior.counts = {3.0, 1.0};
  PropertyPrior friction;
  friction.classes = {{0.8, 2.0, 2.0, 0.01}, {0.4, 2.0, 2.0, 0.01}};
  prior.properties.push_back(friction);
  return prior;
}

// Wet to the left, dry to the right of every lane.
inline FrictionMap friction_of(const std::vector<LanePath>& paths) {
  LaneStrips strips(paths, 1.0, 2.0);
  PropertyMap map(strips.knots(), two_classes());
  for (const PathPlace& place : strips.knots().places())
    (void)map.add_label(place, place.e_m > 0.0 ? 1 : 0, 10.0);
  Random random(1, "values");
  for (const LaneStrips::Strip& strip : strips.strips())
    for (double s = 0.0; s < strip.length_m(); s += 0.5) {
      (void)map.add_value(0, {strip.begin_m + s, -1.0}, 0.85 + random.normal(0.0, 0.02), 0.02);
      (void)map.add_value(0, {strip.begin_m + s, 1.0}, 0.45 + random.normal(0.0, 0.02), 0.02);
    }
  return {std::move(strips),
          std::move(map),
          1.0,
          2.0,
          1'600'000'000'000'000'000,
          {"drive 0"},
          {},
          paths_digest(paths),
          {},
          "{}"};
}

inline SpeedMap speeds_of(const DrivenPlace& place, const FrictionMap& friction) {
  SpeedMap map;
  map.cell_m = 0.5;
  map.date_ns = map.now_ns = 1'600'000'100'000'000'000;
  map.sessions = {"drive 0", "drive 1"};
  map.options.max_speed = 12.0;
  map.paths = paths_digest(place.paths);
  map.ages.put({"people drive 0", map.date_ns - std::int64_t{20'000'000'000}, 10.0});
  map.ages.put({"lanes", map.date_ns, 0.0});
  std::vector<GridLane> lanes;
  for (const LanePath& path : place.paths) {
    const PathCurve curve(path.path);
    lanes.push_back({{}, 3.0});
    for (const double s : even_places(curve, 1.0))
      lanes.back().centre.push_back(curve.at(s).position);
  }
  const PresenceGrid grid(lanes, {}, {}, {});
  for (std::size_t i = 0; i < grid.size(); ++i) {
    SpeedCell cell;
    cell.centre = grid.centres()[i];
    cell.place = grid.place_class(i);
    cell.presence = cell.centre.x() > 40.0 && cell.centre.x() < 44.0 ? 0.7 : 0.05;
    cell.sigma = 0.1;
    cell.pedestrian = recommended_speed(cell.presence, 1.0, 12.0);
    cell.grip = cell.centre.x() < 20.0 ? 6.03 : INFINITY;
    cell.speed = std::min(cell.pedestrian, cell.grip);
    cell.visits = i % 2 == 0 ? 2 : 0;
    cell.newest_ns = i % 2 == 0 ? map.date_ns : 0;
    map.cells.push_back(cell);
  }
  for (const LanePath& path : place.paths) {
    const PathCurve curve(path.path);
    const auto s = even_places(curve, 0.25);
    LaneProfile profile{path.lane, s[1] - s[0], curve.closed(), -1, -1, {}};
    const LaneStrips::Strip* strip = friction.strips.find(path.lane);
    // A lane that crosses itself has no strip.
    const FrictionAt grip = [&](double at, double e) -> std::optional<PropertyMoments> {
      if (strip == nullptr) return std::nullopt;
      return friction.map.moments(0, {strip->begin_m + at, e});
    };
    profile.places =
        speed_limits_along(way_points(curve, s), s, 9.0, presence_of(map), grip, map.options);
    make_feasible(profile.places, profile.step_m, profile.closed, map.options);
    map.profiles.push_back(std::move(profile));
  }
  return map;
}

/// A place with friction and speeds in its map file. Made once for all tests of a program.
struct StoredOnce {
  Folder folder;
  DrivenPlace place;
  std::filesystem::path map;
  FrictionMap friction;
  SpeedMap speeds;
  StoredOnce()
      : map(map_with_paths(folder)),
        friction(friction_of(place.paths)),
        speeds(speeds_of(place, friction)) {
    MapUpdate update(map);
    write_friction_layers(update, friction);
    write_speed_layers(update, speeds);
    update.commit();
  }
};
inline const StoredOnce& stored_once() {
  static const StoredOnce once;
  return once;
}

/// A copy of that place and of its map file, which a test may change.
struct Stored {
  Folder folder;
  DrivenPlace place = stored_once().place;
  std::filesystem::path map = copy_of_map(stored_once().map, folder);
  FrictionMap friction = stored_once().friction;
  SpeedMap speeds = stored_once().speeds;
};

}  // namespace roadbook::test
