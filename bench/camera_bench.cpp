#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "base/random.hpp"
#include "sensors/camera.hpp"

// Nanoseconds a ray: projection with its Jacobian (bundle adjustment, tracking) and bearing
// (features), for rays up to 80 degrees off axis (pinhole: 40).
namespace {

using roadbook::Camera;
using roadbook::CameraModel;

Camera camera_of(int model) {
  switch (model) {
    case 0:
      return {CameraModel::kPinholeRadtan,
              {458.6, 457.3, 367.2, 248.4, -0.283, 0.074, 0.00019, 1.76e-05},
              752,
              480};
    case 1:  // TUM-VI, Kalibr: the quick bound settles every ray
      return {CameraModel::kKannalaBrandt,
              {190.978, 190.973, 254.93, 256.90, 0.0034824, 0.000715, -0.0020532, 0.00020294},
              512,
              512};
    case 2:
      return {CameraModel::kOmni,
              {1.5, 800.0, 801.0, 640.0, 480.0, -0.05, 0.01, 1e-4, -2e-4},
              1280,
              960};
    case 3:
      return {CameraModel::kDoubleSphere,
              {-0.1721, 0.5931, 158.286, 158.274, 254.96, 256.89},
              512,
              512};
    default:  // RealSense T265, Kalibr: large coefficients of both signs need the exact check
      return {CameraModel::kKannalaBrandt,
              {282.020, 280.715, 415.956, 396.661, -0.003269, 0.0540526, -0.0515941, 0.0107492},
              848,
              800};
  }
}

std::vector<Eigen::Vector3d> points_of(int model) {
  roadbook::Random random(1, "camera bench");
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 1024; ++i) {
    const double angle = random.uniform(0.0, model == 0 ? 0.7 : 1.4);
    const double around = random.uniform(0.0, 6.28);
    const double depth = random.uniform(1.0, 20.0);
    points.emplace_back(depth * std::sin(angle) * std::cos(around),
                        depth * std::sin(angle) * std::sin(around), depth * std::cos(angle));
  }
  return points;
}

void label(benchmark::State& state) {
  const int model = static_cast<int>(state.range(0));
  state.SetLabel(std::string(camera_model_name(camera_of(model).model)) +
                 (model == 4 ? " (T265)" : ""));
  state.SetItemsProcessed(state.iterations() * 1024);
}

void project_with_jacobian(benchmark::State& state) {
  const Camera camera = camera_of(static_cast<int>(state.range(0)));
  const auto points = points_of(static_cast<int>(state.range(0)));
  roadbook::Matrix23d J;
  for (auto _ : state)
    for (const auto& p : points) {
      benchmark::DoNotOptimize(camera.project(p, &J));
      benchmark::DoNotOptimize(J);
    }
  label(state);
}

void bearing(benchmark::State& state) {
  const Camera camera = camera_of(static_cast<int>(state.range(0)));
  std::vector<Eigen::Vector2d> pixels;
  for (const auto& p : points_of(static_cast<int>(state.range(0))))
    if (const auto pixel = camera.project(p)) pixels.push_back(*pixel);
  if (pixels.size() != 1024) return state.SkipWithError("a point has no pixel");
  for (auto _ : state)
    for (const auto& pixel : pixels) benchmark::DoNotOptimize(camera.bearing(pixel));
  label(state);
}

BENCHMARK(project_with_jacobian)->DenseRange(0, 4);
BENCHMARK(bearing)->DenseRange(0, 4);

}  // namespace
