#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>
#include <vector>

#include "base/random.hpp"
#include "mapping/occupancy/patch_grid.hpp"
#include "mapping/occupancy/place_patches.hpp"

namespace roadbook {
namespace {

constexpr double kLongest_m = 20.0;

// Grids of 6 m of driving, as patches have them. Scan s belongs to grid s / kScans.
constexpr std::size_t kScans = 60, kBeams = 181;
CellShape shape(std::size_t grid) {
  const double x = 6.0 * static_cast<double>(grid);
  return CellShape::over({x - 20.3, -20.6}, {x + 26.3, 20.6}, 0.1);
}

struct Scans {
  std::vector<Eigen::Vector2d> origins, along;
  std::vector<double> read_m;
};

// 400 scans of 181 beams along 40 m of a hall.
Scans made_scans() {
  Random random(1);
  Scans scans;
  for (int s = 0; s < 400; ++s)
    for (std::size_t b = 0; b < kBeams; ++b) {
      const double a = 0.0349 * static_cast<double>(b) + 0.01 * s;
      scans.origins.emplace_back(0.1 * s, 0.3 * std::sin(0.05 * s));
      scans.along.emplace_back(std::cos(a), std::sin(a));
      const double wall = 6.0 / std::max(0.3, std::abs(scans.along.back().y()));
      scans.read_m.push_back(std::min(kLongest_m, wall + 0.05 * random.normal()));
    }
  return scans;
}

void log_odds_updates(benchmark::State& state) {
  const Scans scans = made_scans();
  RangeMixture mixture = mixture_of({0.03, 0.02, 0.01, 0.5}, 0.05);
  const InverseRangeModel inverse(mixture, kLongest_m, {.cell_m = 0.1});
  std::vector<PatchGrid> grids;
  for (std::size_t g = 0; g * kScans < 400; ++g) grids.emplace_back(shape(g));
  std::size_t updates = 0;
  for (auto _ : state)
    for (std::size_t i = 0; i < scans.read_m.size(); ++i)
      updates += add_beam(grids[i / kBeams / kScans], scans.origins[i], scans.along[i],
                          scans.read_m[i], inverse);
  benchmark::DoNotOptimize(grids.front().cells.data());
  state.counters["cells"] =
      benchmark::Counter(static_cast<double>(updates), benchmark::Counter::kIsRate);
}
BENCHMARK(log_odds_updates)->Unit(benchmark::kMillisecond);

// A plain loop for comparison: Bresenham's line with one value for free cells and one for the last.
void plain_bresenham(benchmark::State& state) {
  const Scans scans = made_scans();
  std::vector<CellShape> shapes;
  std::vector<std::vector<float>> grids;
  for (std::size_t g = 0; g * kScans < 400; ++g) {
    shapes.push_back(shape(g));
    grids.emplace_back(shapes.back().size(), 0.0F);
  }
  std::size_t updates = 0;
  for (auto _ : state)
    for (std::size_t i = 0; i < scans.read_m.size(); ++i) {
      const CellShape& s = shapes[i / kBeams / kScans];
      std::vector<float>& cells = grids[i / kBeams / kScans];
      const Eigen::Vector2d a = (scans.origins[i] - s.low) / s.cell_m;
      const Eigen::Vector2d b = a + scans.along[i] * scans.read_m[i] / s.cell_m;
      int x = static_cast<int>(a.x()), y = static_cast<int>(a.y());
      const int to_x = static_cast<int>(b.x()), to_y = static_cast<int>(b.y());
      const int dx = std::abs(to_x - x), dy = -std::abs(to_y - y);
      const int sx = x < to_x ? 1 : -1, sy = y < to_y ? 1 : -1;
      int error = dx + dy;
      for (;;) {
        if (!s.holds(x, y)) break;
        const bool last = x == to_x && y == to_y;
        cells[s.index(x, y)] += last ? 0.85F : -0.4F;
        ++updates;
        if (last) break;
        const int twice = 2 * error;
        if (twice >= dy) {
          error += dy;
          x += sx;
        }
        if (twice <= dx) {
          error += dx;
          y += sy;
        }
      }
    }
  benchmark::DoNotOptimize(grids.front().data());
  state.counters["cells"] =
      benchmark::Counter(static_cast<double>(updates), benchmark::Counter::kIsRate);
}
BENCHMARK(plain_bresenham)->Unit(benchmark::kMillisecond);

// 1,000 patches of 200 x 200 cells, each turned and moved by a loop closure.
void place_moved_patches(benchmark::State& state) {
  std::vector<OccupancyPatch> patches(1000);
  for (std::size_t i = 0; i < patches.size(); ++i) {
    OccupancyPatch& p = patches[i];
    p.session = p.drive = "bench";
    p.t_ns = p.end_ns = static_cast<std::int64_t>(i);
    p.columns = p.rows = 200;
    p.log_odds.assign(40000, -500);
    p.seen.assign(40000, 5);
    p.hits.assign(40000, 0);
    p.ends.assign(40000, 0);
    // A twentieth of the cells holds a surface.
    for (std::size_t c = i % 20; c < 40000; c += 20) {
      p.log_odds[c] = 2000;
      p.hits[c] = 3;
      p.ends[c] = packed_end({0.2, -0.3});
    }
  }
  double turn = 0.0;
  std::size_t moved = 0;
  for (auto _ : state) {
    turn += 0.02;
    const auto pose = [&](const std::string&, std::int64_t t) -> std::optional<PlanePose> {
      const auto i = static_cast<double>(t);
      return PlanePose{100.0 * std::cos(0.01 * i + turn), 100.0 * std::sin(0.01 * i + turn),
                       0.01 * i + turn};
    };
    const OccupancyGrid grid = place_patches(patches, pose, {});
    moved += grid.moved;
    benchmark::DoNotOptimize(grid.change.data());
  }
  state.counters["patches"] =
      benchmark::Counter(static_cast<double>(moved), benchmark::Counter::kIsRate);
}
BENCHMARK(place_moved_patches)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace roadbook
