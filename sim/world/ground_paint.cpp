#include "sim/world/ground_paint.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "sim/world/ground_marks.hpp"
#include "sim/world/mesh.hpp"
#include "sim/world/noise.hpp"
#include "sim/world/noise_row.hpp"
#include "sim/world/path.hpp"

namespace roadbook {
namespace {

Canvas make_canvas(const GroundSpec& ground, double texel_m, int value) {
  const Eigen::Vector2d size = ((ground.high - ground.low) / texel_m).array().ceil();
  return {
      cv::Mat(static_cast<int>(size.y()), static_cast<int>(size.x()), CV_8UC1, cv::Scalar(value)),
      ground.low, texel_m};
}

/// Light on the floor: rows of lamps, daylight from the walls where there is no ceiling's shade.
void paint_light(const Scenario& scenario, Canvas& light) {
  for (int y = 0; y < light.image.rows; ++y)
    for (int x = 0; x < light.image.cols; ++x) {
      double value = 1.0;
      if (scenario.ceiling) {
        const double spacing = scenario.ceiling->lamp_spacing_m;
        const Eigen::Vector2d p = light.low + light.texel_m * Eigen::Vector2d(x + 0.5, y + 0.5);
        const double wave = std::cos(2.0 * std::numbers::pi * p.x() / spacing) +
                            std::cos(2.0 * std::numbers::pi * p.y() / spacing);
        const double slow =
            fractal_noise(static_cast<float>(p.x() / 9.0), static_cast<float>(p.y() / 9.0), 2, 77);
        value = 0.92 + 0.09 * wave + 0.14 * slow;
      }
      light.image.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(128.0 * value);
    }
}

/// Asphalt or concrete before anything is painted on it.
void paint_asphalt(const Scenario& scenario, Canvas& ground, const RowWork& rows) {
  const auto seed = static_cast<std::uint32_t>(scenario.seed);
  const double base = 255.0 * scenario.ground.brightness;
  const double rough = scenario.ground.roughness;
  rows.run(ground, [&](std::size_t row) {
    auto* out = ground.image.ptr<std::uint8_t>(static_cast<int>(row));
    const auto v =
        static_cast<float>(ground.low.y() + (static_cast<double>(row) + 0.5) * ground.texel_m);
    NoiseRow noise(ground, v);
    const auto& broad = noise.fractal(0.25F, 3, seed);
    const auto& fine = noise.fractal(4.0F, 3, seed + 7);
    const auto& grain = noise.value(45.0F, seed + 13);
    const auto& stones = noise.value(28.0F, seed + 17);
    for (std::size_t i = 0; i < broad.size(); ++i) {
      // Sparse dark and bright stones: the tails of a noise.
      const float tail = std::abs(stones[i]) > 0.62F ? stones[i] * 30.0F : 0.0F;
      out[i] = cv::saturate_cast<std::uint8_t>(
          base * (1.0 + 0.22 * static_cast<double>(broad[i])) +
          rough * static_cast<double>(16.0F * fine[i] + 9.0F * grain[i] + tail));
    }
  });
}

/// Paint wears off in flakes: the mask times a threshold of noise.
void apply_paint(const Canvas& mask,
                 const Scenario& scenario,
                 Canvas& ground,
                 const RowWork& rows) {
  const auto seed = static_cast<std::uint32_t>(scenario.seed) + 31U;
  rows.run(ground, [&](std::size_t row) {
    auto* out = ground.image.ptr<std::uint8_t>(static_cast<int>(row));
    const auto* in = mask.image.ptr<cv::Vec3b>(static_cast<int>(row));
    const double y = ground.low.y() + (static_cast<double>(row) + 0.5) * ground.texel_m;
    for (int i = 0; i < ground.image.cols; ++i) {
      if (in[i][0] == 0) continue;
      const double x = ground.low.x() + (i + 0.5) * ground.texel_m;
      const double wear = in[i][2] / 255.0;
      const double noise =
          0.5 + 0.5 * static_cast<double>(fractal_noise(static_cast<float>(x * 7.0),
                                                        static_cast<float>(y * 7.0), 4, seed));
      const double left = std::clamp((noise - 0.75 * wear) / 0.18 + 0.2, 0.06, 1.0);
      const double share = in[i][0] / 255.0 * (1.0 - 0.35 * wear) * left;
      out[i] = cv::saturate_cast<std::uint8_t>(out[i] + share * (in[i][1] - out[i]));
    }
  });
}

void apply_light(const Canvas& light, Canvas& ground, const RowWork& rows) {
  rows.run(ground, [&](std::size_t row) {
    auto* out = ground.image.ptr<std::uint8_t>(static_cast<int>(row));
    const double scale = ground.texel_m / light.texel_m;
    const double v =
        std::clamp((static_cast<double>(row) + 0.5) * scale - 0.5, 0.0, light.image.rows - 1.001);
    const int v0 = static_cast<int>(v);
    const auto* a = light.image.ptr<std::uint8_t>(v0);
    const auto* b = light.image.ptr<std::uint8_t>(std::min(v0 + 1, light.image.rows - 1));
    for (int i = 0; i < ground.image.cols; ++i) {
      const double u = std::clamp((i + 0.5) * scale - 0.5, 0.0, light.image.cols - 1.001);
      const int u0 = static_cast<int>(u);
      const int u1 = std::min(u0 + 1, light.image.cols - 1);
      const double f = u - u0;
      const double g = v - v0;
      const double factor =
          (1.0 - g) * ((1.0 - f) * a[u0] + f * a[u1]) + g * ((1.0 - f) * b[u0] + f * b[u1]);
      out[i] = cv::saturate_cast<std::uint8_t>(out[i] * factor / 128.0);
    }
  });
}

/// Cars, pillars and walls darken the floor where they stand.
void paint_shadows(const Scenario& scenario, const Layout& layout, Canvas& ground) {
  for (const ParkedCar& car : layout.cars) {
    shade_convex(ground, rectangle(car.centre, car.heading, {4.3, 1.9}), 0.62, 0.9);
    shade_convex(ground, rectangle(car.centre, car.heading, {3.9, 1.5}), 0.5, 0.5);
  }
  for (const BlockSpec& block : scenario.blocks)
    shade_convex(ground,
                 rectangle(block.at, block.heading, block.size + Eigen::Vector2d::Constant(0.2)),
                 0.72, 0.35);
  for (const WallSpec& wall : scenario.walls)
    shade_convex(ground, strip(wall.from, wall.to, 0.7), 0.7, 0.8);
}

void paint_kinds(const Scenario& scenario, const Layout& layout, Canvas& kind) {
  const auto fill = [&](const Polygon& polygon, SurfaceClass c) {
    stamp_convex(kind, polygon, static_cast<std::uint8_t>(c));
  };
  for (const SpaceLine& line : layout.lines)
    if (!line.column) fill(strip(line.front, line.back, line.width_m), SurfaceClass::kMarking);
  for (const CrossingSpec& crossing : scenario.crossings)
    fill(strip(crossing.from, crossing.to, crossing.width_m), SurfaceClass::kCrossing);
}

}  // namespace

PaintedGround paint_ground(const Scenario& scenario, const Layout& layout, const RowWork& rows) {
  const GroundSpec& spec = scenario.ground;
  PaintedGround result{
      make_canvas(spec, spec.texel_m, 0),
      make_canvas(spec, std::max(0.05, 2.0 * spec.texel_m), static_cast<int>(SurfaceClass::kRoad)),
      make_canvas(spec, 0.25, 128)};
  paint_light(scenario, result.light);
  paint_asphalt(scenario, result.brightness, rows);
  paint_road_surface(scenario, result.brightness, result.kind, rows);
  rows.pause();
  paint_wear(scenario, layout, result.brightness);
  Canvas mask = result.brightness;
  mask.image = cv::Mat::zeros(result.brightness.image.size(), CV_8UC3);
  rows.pause();
  paint_markings(scenario, layout, mask);
  apply_paint(mask, scenario, result.brightness, rows);
  rows.pause();
  paint_dirt(scenario, result.brightness);
  apply_light(result.light, result.brightness, rows);
  rows.pause();
  paint_shadows(scenario, layout, result.brightness);
  paint_kinds(scenario, layout, result.kind);
  if (scenario.bays)
    for (Canvas* canvas : {&result.brightness, &result.kind}) repeat_bay(*scenario.bays, *canvas);
  return result;
}

}  // namespace roadbook
