#include <benchmark/benchmark.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "base/random.hpp"
#include "speedmap/experiments/spm_world.hpp"
#include "speedmap/property_map/class_refresh.hpp"
#include "speedmap/property_map/ground_table.hpp"
#include "speedmap/property_map/slice.hpp"

// Measures the operations of one core per second on a property map of two miles (41,860 knots,
// three classes). Compares each with a simple method that tests every knot.

namespace roadbook {
namespace {

PropertyMap two_miles() {
  SpmExperimentOptions options;
  return spm_truth(options, 0).map;
}

std::vector<PathPlace> places_near(double s_m, std::size_t count) {
  Random random(1);
  std::vector<PathPlace> places;
  for (std::size_t i = 0; i < count; ++i)
    places.push_back({s_m + random.uniform(0.0, 90.0), random.uniform(-6.0, 6.0)});
  return places;
}

PropertyMapOptions options_of(SemanticModel semantics) {
  PropertyMapOptions options;
  options.semantics = semantics;
  options.confusion = {0.9, 0.05, 0.05, 0.05, 0.9, 0.05, 0.05, 0.05, 0.9};
  return options;
}

void add_labels(benchmark::State& state, SemanticModel semantics) {
  const PropertyMap truth = two_miles();
  PropertyMap map(truth.knots(), truth.prior(), options_of(semantics));
  const auto places = places_near(1000.0, 4096);
  std::size_t i = 0;
  for (auto _ : state) {
    map.add_label(places[i % places.size()], static_cast<int>(i % 3));
    ++i;
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()));
}
BENCHMARK_CAPTURE(add_labels, geometric_pool, SemanticModel::kGeometricPool);
BENCHMARK_CAPTURE(add_labels, linear_pool, SemanticModel::kLinearPool);
BENCHMARK_CAPTURE(add_labels, discrete, SemanticModel::kDiscrete);

// The simple method evaluates the kernel at every knot.
void add_label_looking_at_every_knot(benchmark::State& state) {
  const PropertyMap truth = two_miles();
  const auto& knots = truth.knots().places();
  std::vector<double> counts(knots.size() * 3, 1.0);
  std::vector<double> k(knots.size());
  const auto places = places_near(1000.0, 4096);
  std::size_t i = 0;
  for (auto _ : state) {
    const PathPlace v = places[i % places.size()];
    double sum = 0.0;
    for (std::size_t l = 0; l < knots.size(); ++l) {
      const double r = std::hypot(v.s_m - knots[l].s_m, v.e_m - knots[l].e_m) / 2.0;
      const double a = 2.0 * M_PI * r;
      k[l] = r < 1.0 ? (2.0 + std::cos(a)) / 3.0 * (1.0 - r) + std::sin(a) / (2.0 * M_PI) : 0.0;
      sum += k[l];
    }
    for (std::size_t l = 0; l < knots.size(); ++l) counts[3 * l + i % 3] += k[l] / sum;
    ++i;
  }
  benchmark::DoNotOptimize(counts.data());
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()));
}
BENCHMARK(add_label_looking_at_every_knot);

void add_property_value(benchmark::State& state) {
  const PropertyMap truth = two_miles();
  PropertyMapOptions options = options_of(SemanticModel::kLinearPool);
  options.gate_counts = 0.0;
  PropertyMap map(truth.knots(), truth.prior(), options);
  Random random(2);
  double s = 0.0;
  for (auto _ : state) {
    s = s < 3000.0 ? s + 0.5 : 0.0;
    benchmark::DoNotOptimize(map.add_value(0, {s, 1.0}, 0.9 + 0.04 * random.uniform()));
  }
}
BENCHMARK(add_property_value);

// A class image of a frame: 100,000 pixels that meet the ground, path projection included.
void frame_of_100000_pixels(benchmark::State& state) {
  const SpmExperimentOptions experiment;
  const PathFrame road = spm_road(experiment);
  const PropertyMap truth = two_miles();
  PropertyMap map(truth.knots(), truth.prior(), options_of(SemanticModel::kLinearPool));
  MountedCamera camera;
  camera.camera.model = CameraModel::kPinholeRadtan;
  camera.camera.width = 640;
  camera.camera.height = 360;
  camera.camera.parameters = {450.0, 450.0, 319.5, 179.5};
  const double pitch = 0.06;
  auto& T = camera.T_vehicle_camera;
  T.linear().col(0) = -Eigen::Vector3d::UnitY();
  T.linear().col(1) = Eigen::Vector3d(-std::sin(pitch), 0.0, -std::cos(pitch));
  T.linear().col(2) = Eigen::Vector3d(std::cos(pitch), 0.0, -std::sin(pitch));
  T.translation().z() = 1.4;
  const GroundTable table(camera, {});
  Random random(3);
  std::vector<std::uint8_t> image(640 * 360);
  for (auto& c : image) c = static_cast<std::uint8_t>(random.below(3));
  std::vector<std::uint32_t> counts;
  double s = 0.0;
  PathCursor cursor;
  for (auto _ : state) {
    s = s < 3000.0 ? s + 1.0 : 0.0;
    const PathPoint at = road.curve().at(s);
    Eigen::Isometry2d T_map_vehicle = Eigen::Isometry2d::Identity();
    T_map_vehicle.linear() = Eigen::Rotation2Dd(at.heading()).toRotationMatrix();
    T_map_vehicle.translation() = at.position;
    table.count(image.data(), 640, 3, counts);
    benchmark::DoNotOptimize(add_frame(
        map, table, counts,
        [&](const Eigen::Vector2d& p) -> std::optional<PathPlace> {
          const PathProjection q = road.project(T_map_vehicle * p, cursor);
          if (!q.inside()) return std::nullopt;
          return PathPlace{q.s_m, q.e_m};
        },
        1.0));
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * table.pixels()));
  state.counters["pixels"] = static_cast<double>(table.pixels());
  state.counters["cells"] = static_cast<double>(table.centres().size());
}
BENCHMARK(frame_of_100000_pixels)->Unit(benchmark::kMillisecond);

void horizon_of_80_points(benchmark::State& state, bool derivatives, bool from_slice) {
  const PropertyMap map = two_miles();
  const SliceView view(make_slice(map, 0, 1000.0, 1100.0));
  for (auto _ : state)
    for (int n = 1; n <= 80; ++n) {
      const PathPlace v{1000.0 + n, 3.5 * std::cos(M_PI / 10.0 * n)};
      if (derivatives && from_slice) benchmark::DoNotOptimize(view.moments_with_derivatives(v));
      if (derivatives && !from_slice) benchmark::DoNotOptimize(map.moments_with_derivatives(0, v));
      if (!derivatives && from_slice) benchmark::DoNotOptimize(view.moments(v));
      if (!derivatives && !from_slice) benchmark::DoNotOptimize(map.moments(0, v));
    }
}
BENCHMARK_CAPTURE(horizon_of_80_points, map, false, false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(horizon_of_80_points, map_with_derivatives, true, false)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(horizon_of_80_points, slice, false, true)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(horizon_of_80_points, slice_with_derivatives, true, true)
    ->Unit(benchmark::kMicrosecond);

void make_a_slice_of_100_m(benchmark::State& state) {
  const PropertyMap map = two_miles();
  for (auto _ : state) benchmark::DoNotOptimize(make_slice(map, 0, 1000.0, 1100.0));
}
BENCHMARK(make_a_slice_of_100_m)->Unit(benchmark::kMicrosecond);

void refresh_of_1200_values(benchmark::State& state) {
  Random random(4);
  std::vector<double> values, weights;
  for (int i = 0; i < 1200; ++i) {
    values.push_back(random.uniform(0.3, 1.0));
    weights.insert(weights.end(), {0.1, 0.8, 0.1});
  }
  const std::vector<NormalGamma> prior(3, {0.6, 0.02, 2.0, 0.004});
  for (auto _ : state) benchmark::DoNotOptimize(refresh_classes(values, weights, prior));
}
BENCHMARK(refresh_of_1200_values)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace roadbook
