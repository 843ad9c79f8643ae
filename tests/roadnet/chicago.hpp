#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "roadnet/build_network.hpp"
#include "roadnet/samples.hpp"
#include "roadnet/spatial_hash.hpp"
#include "tests/roadnet/street_score.hpp"

namespace roadbook::test {

// The Chicago campus shuttle tracks of the map construction benchmark (Ahmed et al. 2015), read
// with the `unzip` command, and how a network found from them compares with OpenStreetMap.

using Line = std::vector<Eigen::Vector3d>;

/// What `unzip -p` prints of the members; empty where it fails.
inline std::string unzip(const std::filesystem::path& archive, const std::string& members) {
  const std::string command = "unzip -p '" + archive.string() + "' '" + members + "' 2>/dev/null";
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string text;
  std::array<char, 65536> buffer{};
  while (pipe) {
    const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe.get());
    if (count == 0) break;
    text.append(buffer.data(), count);
  }
  return text;
}

/// Rows `x y t`. A new pass begins where time goes back or jumps by two minutes, and at gaps of
/// 300 m. Positions are relative to a corner of the area.
inline std::vector<DrivenPass> chicago_passes(const std::filesystem::path& folder) {
  std::istringstream rows(unzip(folder / "tracks_chicago.zip", "chicago/trips/trip_*.txt"));
  std::vector<DrivenPass> passes;
  double x = 0.0;
  double y = 0.0;
  double t = 0.0;
  double last_t = 0.0;
  while (rows >> x >> y >> t) {
    const Eigen::Vector3d at(x - 443000.0, y - 4634000.0, 0.0);
    if (passes.empty() || t < last_t || t > last_t + 120.0 ||
        (at - passes.back().positions.back()).norm() > 300.0) {
      passes.emplace_back();
    }
    passes.back().positions.push_back(at);
    last_t = t;
  }
  return passes;
}

inline std::vector<Line> chicago_reference(const std::filesystem::path& folder) {
  std::istringstream vertices(unzip(folder / "maps_chicago.zip", "chicago_vertices_osm.txt"));
  std::istringstream edges(unzip(folder / "maps_chicago.zip", "chicago_edges_osm.txt"));
  std::map<int, Eigen::Vector3d> place;
  char comma = ',';
  int id = 0;
  double x = 0.0;
  double y = 0.0;
  while (vertices >> id >> comma >> x >> comma >> y) {
    place[id] = {x - 443000.0, y - 4634000.0, 0.0};
  }
  std::vector<Line> lines;
  int a = 0;
  int b = 0;
  int one_way = 0;
  while (edges >> id >> comma >> a >> comma >> b >> comma >> one_way) {
    lines.push_back({place.at(a), place.at(b)});
  }
  return lines;
}

struct TimedPosition {
  Eigen::Vector2d at;  ///< UTM [m]
  double time_s = 0.0;
};
using TimedTrack = std::vector<TimedPosition>;

/// The trips as they were recorded, in UTM coordinates; a new one begins where time goes back or
/// jumps by two minutes.
inline std::vector<TimedTrack> chicago_trips(const std::filesystem::path& folder) {
  std::istringstream rows(unzip(folder / "tracks_chicago.zip", "chicago/trips/trip_*.txt"));
  std::vector<TimedTrack> trips;
  double x = 0.0;
  double y = 0.0;
  double t = 0.0;
  while (rows >> x >> y >> t) {
    if (trips.empty() || t < trips.back().back().time_s || t > trips.back().back().time_s + 120.0)
      trips.emplace_back();
    trips.back().push_back({{x, y}, t});
  }
  return trips;
}

/// One position in `interval_s`, the first `phase_s` after a trip's beginning.
inline std::vector<TimedTrack> thinned(const std::vector<TimedTrack>& trips,
                                       double interval_s,
                                       double phase_s) {
  std::vector<TimedTrack> thin;
  for (const TimedTrack& trip : trips) {
    TimedTrack kept;
    double next_s = trip.front().time_s + phase_s;
    for (const TimedPosition& position : trip) {
      if (position.time_s < next_s) continue;
      kept.push_back(position);
      while (next_s <= position.time_s) next_s += interval_s;
    }
    if (kept.size() > 1) thin.push_back(std::move(kept));
  }
  return thin;
}

inline std::vector<Track> positions_of(const std::vector<TimedTrack>& trips) {
  std::vector<Track> tracks;
  for (const TimedTrack& trip : trips) {
    tracks.emplace_back();
    for (const TimedPosition& position : trip) tracks.back().push_back(position.at);
  }
  return tracks;
}

inline std::vector<DrivenPass> passes_of(const std::vector<TimedTrack>& trips) {
  std::vector<DrivenPass> passes;
  for (const TimedTrack& trip : trips) {
    passes.emplace_back();
    for (const TimedPosition& position : trip)
      passes.back().positions.emplace_back(position.at.x(), position.at.y(), 0.0);
  }
  return passes;
}

/// The street map of the set, in UTM coordinates.
inline StreetMap chicago_streets(const std::filesystem::path& folder) {
  std::istringstream vertices(unzip(folder / "maps_chicago.zip", "chicago_vertices_osm.txt"));
  std::istringstream edges(unzip(folder / "maps_chicago.zip", "chicago_edges_osm.txt"));
  StreetMap map;
  std::map<int, int> place;
  char comma = ',';
  int id = 0;
  double x = 0.0;
  double y = 0.0;
  while (vertices >> id >> comma >> x >> comma >> y) place[id] = map.add_place({x, y});
  int a = 0;
  int b = 0;
  int one_way = 0;
  while (edges >> id >> comma >> a >> comma >> b >> comma >> one_way)
    map.add_street(place.at(a), place.at(b));
  return map;
}

struct RoadLengthScore {
  double precision = 0.0;
  double recall = 0.0;
  double reference_km = 0.0;  ///< driven part of the reference
};

struct Directed {
  Eigen::Vector3d point;
  Eigen::Vector3d direction;
  std::size_t pass;
};

inline std::vector<Directed> points_of(const std::vector<Line>& lines, double step_m) {
  std::vector<Directed> all;
  for (std::size_t l = 0; l < lines.size(); ++l) {
    const Line points = resample({0, false, lines[l]}, step_m).points;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      all.push_back({points[i], (points[i + 1] - points[i]).normalized(), l});
    }
  }
  return all;
}

/// Precision: share of the network's length within `near_m` of the reference. Recall: share of the
/// driven reference within `near_m` of the network; a road counts as driven where at least
/// `min_passes` passes lie within `near_m` and within 30 degrees of its direction.
inline RoadLengthScore compare_by_length(const RoadNetwork& network,
                                         const std::vector<Line>& reference,
                                         const std::vector<DrivenPass>& passes,
                                         double near_m,
                                         std::size_t min_passes) {
  constexpr double kStep_m = 5.0;
  std::vector<Line> lanes;
  for (const Lane& lane : network.lanes) lanes.push_back(lane.centre);
  std::vector<Line> tracks;
  for (const DrivenPass& pass : passes) tracks.push_back(pass.positions);
  const auto hash_of = [&](const std::vector<Directed>& points) {
    SpatialHash hash(near_m);
    for (const Directed& p : points) hash.insert(p.point);
    return hash;
  };
  const auto found = points_of(lanes, kStep_m);
  const auto truth = points_of(reference, kStep_m);
  const auto driven = points_of(tracks, kStep_m);
  const SpatialHash found_hash = hash_of(found);
  const SpatialHash truth_hash = hash_of(truth);
  const SpatialHash driven_hash = hash_of(driven);

  std::size_t good = 0;
  for (const Directed& p : found) good += truth_hash.nearest(p.point, near_m) >= 0 ? 1U : 0U;
  std::size_t wanted = 0;
  std::size_t hit = 0;
  for (const Directed& p : truth) {
    std::set<std::size_t> by;
    driven_hash.visit_near(p.point, near_m, [&](int index, double) {
      const Directed& d = driven[static_cast<std::size_t>(index)];
      if (std::abs(d.direction.dot(p.direction)) > std::cos(0.5236)) by.insert(d.pass);
    });
    if (by.size() < min_passes) continue;
    ++wanted;
    hit += found_hash.nearest(p.point, near_m) >= 0 ? 1U : 0U;
  }
  return {static_cast<double>(good) / static_cast<double>(std::max<std::size_t>(found.size(), 1)),
          static_cast<double>(hit) / static_cast<double>(std::max<std::size_t>(wanted, 1)),
          static_cast<double>(wanted) * kStep_m / 1000.0};
}

}  // namespace roadbook::test
