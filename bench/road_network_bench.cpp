#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

#include "base/random.hpp"
#include "roadnet/attract_tracks.hpp"
#include "roadnet/build_network.hpp"

// Measures the time of a road network from laps of a lot in steps of 20 cm, each lap with a
// separate offset, and the time of the mean shift of satellite tracks (`attract_passes`). The limit
// for 8 laps is one second.

namespace roadbook {
namespace {

/// Two rings that share a side, `size_m` each, driven as a figure of eight.
std::vector<DrivenPass> laps(int count, double size_m, double step_m, double scatter_m) {
  Random random(1, "laps");
  std::vector<DrivenPass> passes;
  for (int lap = 0; lap < count; ++lap) {
    const double offset = scatter_m * random.normal();
    DrivenPass pass;
    pass.session = 0;
    const double radius = size_m / 4.0;
    for (const double side : {1.0, -1.0})
      for (double a = 0.0; a < 2.0 * std::numbers::pi; a += step_m / radius)
        pass.positions.emplace_back((radius + offset) * std::sin(a),
                                    side * (radius - (radius + offset) * std::cos(a)), 0.0);
    passes.push_back(pass);
  }
  return passes;
}

void build_lot(benchmark::State& state) {
  const auto passes = laps(static_cast<int>(state.range(0)), 120.0, 0.2, 0.2);
  for (auto _ : state) benchmark::DoNotOptimize(build_road_network(passes).lanes.size());
}
BENCHMARK(build_lot)->Arg(1)->Arg(8)->Arg(32)->Unit(benchmark::kMillisecond);

void draw_tracks_together(benchmark::State& state) {
  const auto passes = laps(static_cast<int>(state.range(0)), 2000.0, 10.0, 10.0);
  double driven_km = 0.0;
  for (const auto& pass : passes) driven_km += 0.01 * static_cast<double>(pass.positions.size());
  for (auto _ : state) benchmark::DoNotOptimize(attract_passes(passes, {}).size());
  state.counters["km"] = driven_km;
}
BENCHMARK(draw_tracks_together)->Arg(20)->Arg(100)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace roadbook
