#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "roadnet/paths/path_fit.hpp"
#include "roadnet/paths/path_frame.hpp"

// Measures the fit of a path of two miles in 40 segments, and projections per second along a drive
// (20 m/s, weaving). Projections are warm, cold, or by a simple method: the nearest of samples
// every 0.5 m, then Newton's method.
namespace {

using namespace roadbook;  // NOLINT

constexpr double kLength = 3218.7;

std::vector<Eigen::Vector3d> road(int count) {
  std::vector<Eigen::Vector3d> points{Eigen::Vector3d::Zero()};
  const double h = kLength / (count - 1);
  for (int i = 1; i < count; ++i) {
    const double s = h * (i - 0.5);
    const double a = std::sin(2 * std::numbers::pi * s / 1100.0) +
                     0.5 * std::sin(2 * std::numbers::pi * s / 420.0) +
                     0.12 * std::sin(2 * std::numbers::pi * s / 150.0);
    points.push_back(points.back() + h * Eigen::Vector3d(std::cos(a), std::sin(a), 0.0));
  }
  return points;
}

const PathFrame& frame() {
  static const PathFrame instance(PathCurve(fit_path(road(281)).path), {-6.0, 6.0});
  return instance;
}

// Places along the road, `step` metres apart, weaving by 3 m.
std::vector<Eigen::Vector2d> drive(double step) {
  std::vector<Eigen::Vector2d> places;
  for (double s = 1.0; s < kLength - 5.0; s += step)
    places.push_back(*frame().position(s, 3.0 * std::sin(s / 20.0)));
  return places;
}

void FitTwoMiles(benchmark::State& state) {
  const auto points = road(281);
  for (auto _ : state) benchmark::DoNotOptimize(fit_path(points));
}
BENCHMARK(FitTwoMiles)->Unit(benchmark::kMillisecond);

void FitTwoMilesDense(benchmark::State& state) {
  const auto points = road(6437);  // every half metre
  for (auto _ : state) benchmark::DoNotOptimize(fit_path(points));
}
BENCHMARK(FitTwoMilesDense)->Unit(benchmark::kMillisecond);

void PrepareCurve(benchmark::State& state) {
  const BezierPath path = fit_path(road(281)).path;
  for (auto _ : state) benchmark::DoNotOptimize(PathCurve(path));
}
BENCHMARK(PrepareCurve)->Unit(benchmark::kMillisecond);

void PrepareFrameWithLemma1(benchmark::State& state) {
  const PathCurve curve(fit_path(road(281)).path);
  for (auto _ : state) benchmark::DoNotOptimize(PathFrame(curve, {-6.0, 6.0}));
}
BENCHMARK(PrepareFrameWithLemma1)->Unit(benchmark::kMillisecond);

// Argument: centimetres between queries.
void ProjectWarm(benchmark::State& state) {
  const auto places = drive(0.01 * static_cast<double>(state.range(0)));
  PathCursor cursor;
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(frame().project(places[i], cursor));
    if (++i == places.size()) i = 0;
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(ProjectWarm)->Arg(5)->Arg(50)->Arg(500);

void ProjectCold(benchmark::State& state) {
  const auto places = drive(7.3);
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(frame().project(places[i]));
    if (++i == places.size()) i = 0;
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(ProjectCold);

void ProjectStraightforward(benchmark::State& state) {
  const PathCurve& curve = frame().curve();
  std::vector<Eigen::Vector2d> samples;
  for (double s = 0.0; s <= kLength; s += 0.5) samples.push_back(curve.at(s).position);
  const auto places = drive(7.3);
  std::size_t i = 0;
  for (auto _ : state) {
    const Eigen::Vector2d& p = places[i];
    std::size_t best = 0;
    for (std::size_t k = 1; k < samples.size(); ++k)
      if ((samples[k] - p).squaredNorm() < (samples[best] - p).squaredNorm()) best = k;
    double s = 0.5 * static_cast<double>(best);
    double e = 0.0;
    for (int n = 0; n < 4; ++n) {
      const PathPoint g = curve.at(s);
      e = g.left().dot(p - g.position);
      s += g.tangent.dot(p - g.position) / (1.0 - g.curvature * e);
    }
    benchmark::DoNotOptimize(s + e);
    if (++i == places.size()) i = 0;
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(ProjectStraightforward);

void Place(benchmark::State& state) {
  double s = 0.0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(frame().position(s, 1.0));
    s = s > 3200.0 ? 0.0 : s + 1.7;
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(Place);

}  // namespace
