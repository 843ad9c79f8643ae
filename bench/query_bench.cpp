#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "base/random.hpp"
#include "roadnet/paths/path_fit.hpp"
#include "speedmap/speeds/path_query.hpp"

// Measures a query at (s, e) of a lane: speed, presence and friction alone, and with occupancy and
// labels: a grid of 100 x 100 m with cells of 0.1 m, and a parking space every 2.5 m on both sides.
namespace {

using namespace roadbook;  // NOLINT

constexpr double kRadius_m = 30.0;

LanePath ring() {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 300; ++i) {
    const double a = 2.0 * M_PI * i / 300;
    points.emplace_back(kRadius_m * std::cos(a), kRadius_m * std::sin(a), 0.0);
  }
  PathFitOptions fit;
  fit.closed = true;
  fit.segments = 16;
  LanePath lane;
  lane.lane = 1;
  lane.path = fit_path(points, fit).path;
  lane.length_m = PathCurve(lane.path).length_m();
  lane.tube_m = 4.0;
  return lane;
}

OccupancyField grid() {
  OccupancyCells cells;
  cells.low = {-50.0, -50.0};
  cells.columns = cells.rows = 1000;
  Random random(1, "cells");
  for (int i = 0; i < 1000 * 1000; ++i) {
    cells.probability.push_back(static_cast<float>(random.uniform(0.01, 0.99)));
    cells.sigma.push_back(0.05F);
    cells.age_s.push_back(10.0F);
  }
  return OccupancyField(std::move(cells));
}

LabelField spaces() {
  std::vector<LabelledOutline> labels;
  for (const double radius : {kRadius_m - 6.0, kRadius_m + 6.0})
    for (double s = 0.0; s < 2.0 * M_PI * kRadius_m; s += 2.5) {
      const double a = s / kRadius_m;
      const Eigen::Vector2d out(std::cos(a), std::sin(a));
      const Eigen::Vector2d along(-out.y(), out.x());
      const Eigen::Vector2d c = radius * out;
      LabelledOutline box;
      box.kind = "parking_space";
      box.id = static_cast<std::int64_t>(labels.size());
      box.sigma_m = 0.1;
      for (const auto& [x, y] : {std::pair{2.5, 1.2}, {2.5, -1.2}, {-2.5, -1.2}, {-2.5, 1.2}})
        box.corners.emplace_back(c + x * out + y * along);
      labels.push_back(box);
    }
  return LabelField(std::move(labels));
}

struct Lane {
  LaneSpeedOptions options;
  LaneStrips strips{{ring()}, 1.0, 2.0};
  PropertyMapPrior prior = [] {
    PropertyMapPrior two;
    two.classes = {"dry", "wet"};
    two.counts = {3.0, 1.0};
    PropertyPrior about;
    about.classes = {{0.8, 2.0, 2.0, 0.01}, {0.4, 2.0, 2.0, 0.01}};
    two.properties.push_back(about);
    return two;
  }();
  PropertyMap friction{strips.knots(), prior};
  LaneProfile profile{1, 0.5, true, -1, -1, {}};
  OccupancyField occupancy = grid();
  LabelField labels = spaces();

  Lane() {
    for (const PathPlace& place : strips.knots().places())
      (void)friction.add_label(place, place.e_m > 0.0 ? 1 : 0, 10.0);
    const PathCurve& curve = strips.strips()[0].frame.curve();
    const auto s = even_places(curve, 0.5);
    profile.step_m = curve.length_m() / static_cast<double>(s.size());
    profile.places = speed_limits_along(way_points(curve, s), s, 9.0, presence, {}, options);
  }
  [[nodiscard]] LaneQuery query(const GroundFields& fields) const {
    return {strips, profile, presence, {}, &friction, options, 1.0, fields};
  }
  static std::optional<PresenceValue> presence(const Eigen::Vector2d& p) {
    return PresenceValue{0.3 + 0.2 * std::sin(p.x()), 0.01};
  }
};

void ask(benchmark::State& state, bool occupancy, bool labels) {
  static const Lane lane;
  const LaneQuery query =
      lane.query({occupancy ? &lane.occupancy : nullptr, labels ? &lane.labels : nullptr});
  double s = 0.0;
  for (auto _ : state) {
    s = std::fmod(s + 0.731, 188.0);
    benchmark::DoNotOptimize(query.at(s, 3.5 * std::sin(s)));
  }
}

void QuerySpeedAndFriction(benchmark::State& state) { ask(state, false, false); }
BENCHMARK(QuerySpeedAndFriction);

void QueryWithOccupancy(benchmark::State& state) { ask(state, true, false); }
BENCHMARK(QueryWithOccupancy);

void QueryWithLabels(benchmark::State& state) { ask(state, false, true); }
BENCHMARK(QueryWithLabels);

void QueryEverything(benchmark::State& state) { ask(state, true, true); }
BENCHMARK(QueryEverything);

}  // namespace
