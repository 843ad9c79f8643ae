#include <algorithm>
#include <cmath>

#include "sim/world/blob.hpp"
#include "sim/world/ground_marks.hpp"
#include "sim/world/mesh.hpp"
#include "sim/world/noise_row.hpp"
#include "sim/world/path.hpp"

// Surfaces on and next to a road: grass, gravel, water.

namespace roadbook {
namespace {

/// Brightness of every surface except asphalt; noise frays the borders.
void paint_by_kind(const Scenario& scenario,
                   const Canvas& kind,
                   Canvas& ground,
                   const RowWork& rows) {
  const auto seed = static_cast<std::uint32_t>(scenario.seed) + 51U;
  rows.run(ground, [&](std::size_t row) {
    auto* out = ground.image.ptr<std::uint8_t>(static_cast<int>(row));
    const double y = ground.low.y() + (static_cast<double>(row) + 0.5) * ground.texel_m;
    NoiseRow noise(ground, static_cast<float>(y));
    const auto& fray = noise.fractal(2.5F, 3, seed);
    const auto& grass = noise.fractal(5.0F, 3, seed + 3);
    const auto& meadow = noise.fractal(0.3F, 3, seed + 4);
    const auto& gravel = noise.fractal(9.0F, 3, seed + 5);
    for (std::size_t i = 0; i < fray.size(); ++i) {
      const double x = ground.low.x() + (static_cast<double>(i) + 0.5) * ground.texel_m;
      const double off = 0.25 * static_cast<double>(fray[i]);
      const Eigen::Vector2d texel = kind.texel({x + off, y - off});
      const int kx = std::clamp(static_cast<int>(std::lround(texel.x())), 0, kind.image.cols - 1);
      const int ky = std::clamp(static_cast<int>(std::lround(texel.y())), 0, kind.image.rows - 1);
      switch (static_cast<SurfaceClass>(kind.image.at<std::uint8_t>(ky, kx))) {
        case SurfaceClass::kGrass:
          out[i] = cv::saturate_cast<std::uint8_t>(82.0F + 40.0F * grass[i] + 25.0F * meadow[i]);
          break;
        case SurfaceClass::kGravel:
          out[i] = cv::saturate_cast<std::uint8_t>(135.0F + 70.0F * gravel[i]);
          break;
        case SurfaceClass::kWater:
          out[i] = cv::saturate_cast<std::uint8_t>(0.55 * out[i]);
          break;
        default:
          break;
      }
    }
  });
}

}  // namespace

void paint_road_surface(const Scenario& scenario,
                        Canvas& ground,
                        Canvas& kind,
                        const RowWork& rows) {
  const GroundSpec& spec = scenario.ground;
  if (spec.gravel_edge_m <= 0.0 && spec.wet_per_are <= 0.0) return;
  Random random(scenario.seed, "road surface");
  kind.image.setTo(static_cast<int>(SurfaceClass::kGrass));
  const auto stamp = [&](const Polygon& p, SurfaceClass c) {
    stamp_convex(kind, p, static_cast<std::uint8_t>(c));
  };
  for (const bool road : {false, true})
    for (const LaneSpec& lane : scenario.lanes) {
      const DrivingLine line(lane.points, scenario.vehicle.turn_radius_m, lane.closed);
      const double width = lane.width_m + (road ? 0.0 : 2.0 * spec.gravel_edge_m);
      for (double s = -1.0; s < line.length_m() + 1.0; s += 1.0)
        stamp(strip(line.at(s), line.at(s + 1.2), width),
              road ? SurfaceClass::kRoad : SurfaceClass::kGravel);
      if (!road) continue;
      const int wet =
          static_cast<int>(line.length_m() * lane.width_m / 100.0 * spec.wet_per_are + 0.5);
      for (int i = 0; i < wet; ++i) {
        const double s = random.uniform(0.0, line.length_m());
        const double h = line.heading(s);
        const double e = random.uniform(-0.4, 0.4) * lane.width_m;
        const Eigen::Vector2d centre = line.at(s) + e * Eigen::Vector2d(-std::sin(h), std::cos(h));
        stamp(blob(centre, random.uniform(0.5, 2.0), random), SurfaceClass::kWater);
      }
    }
  paint_by_kind(scenario, kind, ground, rows);
}

}  // namespace roadbook
