#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "base/random.hpp"
#include "base/se3.hpp"
#include "semantics/labels/labels.hpp"
#include "tests/support/fisheye_rig.hpp"

// Measures how long the anchors of labels take, which an import of a label file computes: with a
// scan of all keyframes for each label, and with the index of the keyframes (its construction
// included). Arguments: number of keyframes and of labels.

namespace roadbook {
namespace {

constexpr double kSpacingM = 0.8;
constexpr double kAisleM = 100.0;
constexpr double kAisleApartM = 16.0;

// A session that drives along parallel aisles.
Map car_park(std::size_t keyframes) {
  Map map;
  map.sessions.emplace_back();
  map.sessions.front().rig = test::fisheye_rig();
  for (std::size_t i = 0; i < keyframes; ++i) {
    const double s_m = kSpacingM * static_cast<double>(i);
    const double aisle = std::floor(s_m / kAisleM);
    Keyframe k;
    k.t_ns = static_cast<std::int64_t>(i) * 100'000'000;
    k.map_frame = static_cast<int>(i);
    map.keyframes.push_back(k);
    map.map_frames.push_back({pose_from_planar(s_m - aisle * kAisleM, aisle * kAisleApartM, 0.0)});
  }
  return map;
}

std::vector<std::vector<Eigen::Vector2d>> outlines(const Map& map, std::size_t labels) {
  Random random(1);
  const double height = map.map_frames.back().T_map_frame.translation().y();
  std::vector<std::vector<Eigen::Vector2d>> all;
  for (std::size_t i = 0; i < labels; ++i) {
    const OrientedBox box{
        {random.uniform(0.0, kAisleM), random.uniform(-5.0, height + 5.0)}, 1.57, 5.0, 2.5};
    const auto corners = box.corners();
    all.emplace_back(corners.begin(), corners.end());
  }
  return all;
}

void scan_of_keyframes(benchmark::State& state) {
  const Map map = car_park(static_cast<std::size_t>(state.range(0)));
  const auto all = outlines(map, static_cast<std::size_t>(state.range(1)));
  for (auto _ : state)
    for (const auto& corners : all) benchmark::DoNotOptimize(anchor_for(map, corners));
}

void index_of_keyframes(benchmark::State& state) {
  const Map map = car_park(static_cast<std::size_t>(state.range(0)));
  const auto all = outlines(map, static_cast<std::size_t>(state.range(1)));
  for (auto _ : state) {
    const KeyframeIndex keyframes(map);
    for (const auto& corners : all) benchmark::DoNotOptimize(anchor_for(keyframes, corners));
  }
}

void sizes(benchmark::internal::Benchmark* bench) {
  bench->Args({5000, 2000})->Args({5000, 1})->Args({80, 24})->Args({80, 1});
  bench->Unit(benchmark::kMillisecond);
}
BENCHMARK(scan_of_keyframes)->Apply(sizes);
BENCHMARK(index_of_keyframes)->Apply(sizes);

}  // namespace
}  // namespace roadbook
