#pragma once

#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/exchange/stored_speeds.hpp"

namespace roadbook::test {

using Points = std::vector<Eigen::Vector2d>;

/// Positions every 0.2 m along straight lines whose corners are cut over `round_m` to either side.
inline DrivenPass driven_along(const Points& corners, double round_m = 6.0) {
  Points line{corners.front()};
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const Eigen::Vector2d& c = corners[i];
    const double before = (corners[i - 1] - c).norm();
    const double after = (corners[i + 1] - c).norm();
    const Eigen::Vector2d a = c + std::min(round_m / before, 0.5) * (corners[i - 1] - c);
    const Eigen::Vector2d b = c + std::min(round_m / after, 0.5) * (corners[i + 1] - c);
    for (int k = 0; k <= 40; ++k) {
      const double u = k / 40.0;
      line.push_back((1 - u) * (1 - u) * a + 2 * u * (1 - u) * c + u * u * b);
    }
  }
  line.push_back(corners.back());
  DrivenPass pass;
  double rest = 0.0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const double length = (line[i + 1] - line[i]).norm();
    for (; rest < length; rest += 0.2) {
      const Eigen::Vector2d p = line[i] + rest / length * (line[i + 1] - line[i]);
      pass.positions.emplace_back(p.x(), p.y(), 0.02 * p.x());
    }
    rest -= length;
  }
  return pass;
}

/// Road network and paths of passes.
inline DrivenPlace driven_place(std::vector<DrivenPass> passes) {
  DrivenPlace place;
  place.passes = std::move(passes);
  place.network = build_road_network(place.passes);
  place.paths = lane_paths(place.network, place.passes);
  return place;
}

/// Two blocks side by side, the street between them driven both ways, the outer ones one way.
inline DrivenPlace cross_place() {
  const Eigen::Vector2d a(6, 6), b(30, 6), c(56, 6), d(56, 36), e(30, 36), f(6, 36);
  return driven_place(
      {driven_along({a, b, c, d, e, f, a, b, e, f, a, b, c, d, e, b, c, d, e, f, a})});
}

/// A ring without any intersection, driven counter-clockwise and, if asked, back as well.
inline DrivenPlace ring_place(bool both_ways, const RoundedRectangle& road = {40.0, 25.0, 5.5}) {
  std::vector<DrivenPass> passes = drive_round(road, 3, 0.05, 7);
  if (both_ways) {
    passes.push_back(passes.front());
    std::reverse(passes.back().positions.begin(), passes.back().positions.end());
  }
  return driven_place(std::move(passes));
}

/// A street in and out, and a loop at its end that returns to where it begins.
inline DrivenPlace loop_place(bool both_ways) {
  const Points round{{0, 0}, {60, 0}, {95, 0}, {95, 30}, {60, 30}, {60, 0}, {0, 0}};
  std::vector<DrivenPass> passes{driven_along(round), driven_along(round)};
  if (both_ways) passes.push_back(driven_along({round.rbegin(), round.rend()}));
  return driven_place(std::move(passes));
}

/// Side streets that join a main street a few metres apart, so that the lane between is short.
inline DrivenPlace staggered_place(double apart_m) {
  const Eigen::Vector2d west(0, 0), east(90, 0), north(40, 30), south(40 + apart_m, -30);
  const Eigen::Vector2d n(40, 0), s(40 + apart_m, 0);
  std::vector<DrivenPass> passes;
  for (const Points& way :
       {Points{west, n, s, east}, Points{east, s, n, west}, Points{west, n, north},
        Points{north, n, s, south}, Points{south, s, east}, Points{east, s, south}})
    for (int lap = 0; lap < 2; ++lap) passes.push_back(driven_along(way, 4.0));
  return driven_place(std::move(passes));
}

/// A main street, and a side street that bends away right after it leaves, where lanes are cut.
inline DrivenPlace bent_place(double bend_m) {
  const Eigen::Vector2d west(0, 0), east(90, 0), middle(45, 0), corner(45, bend_m), end(85, bend_m);
  std::vector<DrivenPass> passes;
  for (const Points& way :
       {Points{west, east}, Points{east, west}, Points{west, middle, corner, end},
        Points{end, corner, middle, west}, Points{east, middle, corner, end}})
    for (int lap = 0; lap < 2; ++lap) passes.push_back(driven_along(way, 4.5));
  return driven_place(std::move(passes));
}

/// A parking space or crossing in the map frame.
struct Outline {
  std::string layer;  ///< parking_spaces, crossings
  Points corners;
};

inline Outline rectangle(const std::string& layer,
                         const Eigen::Vector2d& middle,
                         double turn_rad,
                         double length_m,
                         double width_m) {
  const Eigen::Rotation2Dd turn(turn_rad);
  Outline outline{layer, {}};
  for (const auto& [u, v] : {std::pair{-0.5, -0.5}, {-0.5, 0.5}, {0.5, 0.5}, {0.5, -0.5}})
    outline.corners.push_back(middle + turn * Eigen::Vector2d(u * length_m, v * width_m));
  return outline;
}

/// Spaces to both sides of every path, in bends too, opposite each other or nearly so, and
/// crossings over it.
inline std::vector<Outline> outlines_along(const std::vector<LanePath>& paths) {
  std::vector<Outline> outlines;
  for (const LanePath& path : paths) {
    if (path.status == LanePathStatus::kDegenerate || path.length_m < 12.0) continue;
    const PathCurve curve(path.path);
    for (double s = 4.0; s < curve.length_m() - 4.0; s += 5.3) {
      const PathPoint left = curve.at(s);
      const PathPoint right = curve.at(s + 0.06);
      outlines.push_back(rectangle("parking_spaces", left.position + 5.1 * left.left(),
                                   left.heading() + 1.4, 5.0, 2.4));
      outlines.push_back(rectangle("parking_spaces", right.position - 5.4 * right.left(),
                                   right.heading() - 1.7, 5.2, 2.3));
    }
    const PathPoint at = curve.at(0.4 * curve.length_m());
    outlines.push_back(rectangle("crossings", at.position, at.heading() + 0.2, 3.0, 5.0));
  }
  return outlines;
}

inline void write_outlines(MapUpdate& update, const std::vector<Outline>& outlines) {
  for (const char* name : {"parking_spaces", "crossings"}) {
    VectorLayer layer;
    layer.name = name;
    layer.type = GeometryType::kPolygonZ;
    layer.fields = {{"space", FieldType::kInteger}};
    for (const Outline& outline : outlines) {
      if (outline.layer != name) continue;
      Feature feature;
      for (const Eigen::Vector2d& p : outline.corners)
        feature.points.emplace_back(p.x(), p.y(), 0.02 * p.x(), 0.0);
      feature.points.push_back(feature.points.front());
      feature.values = {static_cast<std::int64_t>(layer.features.size())};
      layer.features.push_back(std::move(feature));
    }
    if (!layer.features.empty()) update.write_layer(layer);
  }
}

/// Makes a map file of a place, with or without speeds. Speeds of lanes agree at intersections.
/// Where x is 40.5 to 43 m, no speed exceeds `crawl` [m/s].
inline std::filesystem::path sumo_map(const Folder& folder,
                                      const DrivenPlace& place,
                                      const std::vector<Outline>& outlines,
                                      bool with_speeds,
                                      double crawl = INFINITY) {
  const auto path = folder / "place.gpkg";
  MapFileBuilder(path, "key").finish(small_map(1), {});
  MapUpdate update(path);
  const NetworkSource source{"drive 0", "2014-06-24T18:02:59.763Z", 0.02};
  write_network_layers(update, place.network, source);
  write_path_layers(update, place.paths, place.network, source);
  write_outlines(update, outlines);
  if (with_speeds) {
    DrivenPlace stored = place;  // degenerate lanes have no path in the file
    std::erase_if(stored.paths,
                  [](const LanePath& one) { return one.status == LanePathStatus::kDegenerate; });
    const FrictionMap friction = friction_of(stored.paths);
    SpeedMap speeds = speeds_of(stored, friction);
    for (LaneProfile& profile : speeds.profiles)
      for (const Lane& lane : place.network.lanes)
        if (lane.id == profile.lane) {
          profile.from_intersection = lane.from_intersection;
          profile.to_intersection = lane.to_intersection;
        }
    for (LaneProfile& profile : speeds.profiles) {
      for (LaneSpeed& at : profile.places)
        if (at.position.x() > 40.5 && at.position.x() < 43.0) at.speed = std::min(at.speed, crawl);
      make_feasible(profile.places, profile.step_m, profile.closed, speeds.options);
    }
    agree_at_intersections(speeds.profiles, speeds.options);
    write_friction_layers(update, friction);
    write_speed_layers(update, speeds);
  }
  update.commit();
  return path;
}

}  // namespace roadbook::test
