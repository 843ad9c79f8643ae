#include "sim/world/surface_paint.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "sim/world/noise.hpp"
#include "sim/world/noise_row.hpp"
#include "sim/world/paint.hpp"

namespace roadbook {
namespace {

Canvas plain(double length_m,
             double height_m,
             double texel_m,
             double base,
             double contrast,
             Random& random) {
  const auto texels = [&](double m) {
    return std::max(8, static_cast<int>(std::ceil(m / texel_m)));
  };
  Canvas c{cv::Mat(texels(height_m), texels(length_m), CV_8UC1), Eigen::Vector2d::Zero(), texel_m};
  const auto seed = static_cast<std::uint32_t>(random());
  for (int y = 0; y < c.image.rows; ++y) {
    const auto v = static_cast<float>((y + 0.5) * texel_m);
    NoiseRow noise(c, v);
    const auto& broad = noise.fractal(1.0F / 1.5F, v / 2.5F, 4, seed);
    const auto& fine = noise.fractal(9.0F, 2, seed + 5);
    const auto& grain = noise.value(60.0F, seed + 9);
    auto* out = c.image.ptr<std::uint8_t>(y);
    for (std::size_t i = 0; i < broad.size(); ++i) {
      const float value = 1.6F * broad[i] + 0.8F * fine[i] + 0.5F * grain[i];
      out[i] = cv::saturate_cast<std::uint8_t>(base + contrast * static_cast<double>(value));
    }
  }
  return c;
}

void add_formwork(Canvas& c, double length, double height) {
  for (double x = 1.25; x < length; x += 1.25)
    fill_convex(c, strip({x, 0}, {x, height}, 0.02), 60, 0.6);
  for (double y = 1.1; y < height; y += 1.1)
    fill_convex(c, strip({0, y}, {length, y}, 0.02), 60, 0.6);
  for (double x = 0.3; x < length; x += 0.625)
    for (double y = 0.4; y < height; y += 0.75)
      fill_convex(c, rectangle({x, y}, 0.0, {0.035, 0.035}), 30, 0.8);
}

void add_bricks(Canvas& c, double length, double height, Random& random) {
  int course = 0;
  for (double y = 0.0; y < height; y += 0.08, ++course)
    for (double x = course % 2 == 0 ? 0.0 : -0.12; x < length; x += 0.25)
      fill_convex(c, rectangle({x + 0.12, y + 0.035}, 0.0, {0.235, 0.065}),
                  random.uniform(70.0, 150.0), 0.75);
}

void add_panels(Canvas& c, double length, double height, Random& random) {
  for (double x = 0.0; x < length; x += 2.4) {
    fill_convex(c, rectangle({x + 1.2, 0.5 * height}, 0.0, {2.3, height - 0.2}),
                random.uniform(110.0, 165.0), 0.4);
    fill_convex(c, strip({x, 0}, {x, height}, 0.05), 45, 0.9);
    fill_convex(c, strip({x, 1.0}, {x + 2.4, 1.0}, 0.06), 205, 0.8);
  }
}

void add_windows(Canvas& c, double length, double height, Random& random) {
  for (double y = 1.0; y + 1.6 < height; y += 3.0)
    for (double x = 0.8; x + 1.2 < length; x += 2.2) {
      fill_convex(c, rectangle({x + 0.6, y + 0.7}, 0.0, {1.3, 1.5}), 215, 0.9);
      fill_convex(c, rectangle({x + 0.6, y + 0.7}, 0.0, {1.1, 1.3}), random.uniform(25.0, 90.0),
                  0.95);
      fill_convex(c, strip({x + 0.6, y}, {x + 0.6, y + 1.4}, 0.06), 215, 0.9);
    }
}

void add_dirt(Canvas& c, double length, double height, Random& random) {
  const double area = length * height;
  for (int i = 0; i < static_cast<int>(1.2 * area); ++i) {  // runs of water
    const double x = random.uniform(0.0, length);
    const double top = random.uniform(0.2, height);
    fill_convex(
        c,
        strip({x, top}, {x + 0.03 * random.normal(), std::max(0.0, top - random.uniform(0.1, 0.9))},
              random.uniform(0.01, 0.06)),
        random.below(2) == 0 ? 45 : 190, random.uniform(0.1, 0.35));
  }
  for (int i = 0; i < static_cast<int>(5.0 * area); ++i)
    fill_convex(c,
                rectangle({random.uniform(0.0, length), random.uniform(0.0, height)},
                          random.uniform(0.0, 3.0),
                          {random.uniform(0.01, 0.08), random.uniform(0.01, 0.05)}),
                random.uniform(30.0, 200.0), random.uniform(0.2, 0.6));
  for (double x = 0.0; x < length; x += 0.4)  // rubber and soot at the foot
    fill_convex(c, strip({x, 0.05}, {x + 0.5, 0.05}, random.uniform(0.1, 0.4)), 35, 0.3, 0.1);
}

void add_poster(Canvas& c, const Eigen::Vector2d& centre, Random& random) {
  const double w = random.uniform(0.4, 1.1);
  const double h = random.uniform(0.4, 0.9);
  fill_convex(c, rectangle(centre, 0.0, {w, h}), random.uniform(150.0, 245.0), 1.0);
  for (int i = 0; i < 7; ++i)
    fill_convex(c,
                rectangle(centre + Eigen::Vector2d(random.uniform(-0.3, 0.3) * w,
                                                   random.uniform(-0.35, 0.35) * h),
                          0.0, {random.uniform(0.1, 0.4) * w, random.uniform(0.05, 0.25) * h}),
                random.uniform(10.0, 240.0), 1.0);
  static const char* const kWords[] = {"EXIT", "P",    "STOP", "30",   "LIFT",
                                       "TAXI", "CAFE", "NO 5", "EAST", "WC"};
  draw_text(c, kWords[random.below(10)], centre + Eigen::Vector2d(0.0, 0.25 * h), 0.0, 0.16, 20,
            1.0);
}

}  // namespace

cv::Mat paint_wall(SurfaceTexture texture,
                   double length_m,
                   double height_m,
                   double texel_m,
                   int posters,
                   bool windows,
                   Random& random) {
  static constexpr double kBase[] = {125.0, 95.0, 140.0, 165.0};
  Canvas c = plain(length_m, height_m, texel_m, kBase[static_cast<int>(texture)], 22.0, random);
  if (texture == SurfaceTexture::kConcrete) add_formwork(c, length_m, height_m);
  if (texture == SurfaceTexture::kBrick) add_bricks(c, length_m, height_m, random);
  if (texture == SurfaceTexture::kPanel) add_panels(c, length_m, height_m, random);
  if (texture == SurfaceTexture::kPlaster)
    fill_convex(c, strip({0, 0.5}, {length_m, 0.5}, 1.0), 95, 0.7);
  if (windows) add_windows(c, length_m, height_m, random);
  add_dirt(c, length_m, height_m, random);
  if (height_m > 2.2 && height_m < 6.0) {
    fill_convex(c, strip({0, 2.15}, {length_m, 2.15}, 0.09), 175, 1.0);  // a pipe with its clamps
    fill_convex(c, strip({0, 2.115}, {length_m, 2.115}, 0.03), 70, 1.0);
    for (double x = 0.7; x < length_m; x += 1.9)
      fill_convex(c, rectangle({x, 2.15}, 0.0, {0.06, 0.14}), 50, 1.0);
  }
  for (int i = 0; i < posters; ++i)
    add_poster(c, {(i + random.uniform(0.25, 0.75)) * length_m / posters, random.uniform(1.1, 1.7)},
               random);
  return c.image;
}

cv::Mat paint_ceiling(const CeilingSpec& ceiling,
                      const Eigen::Vector2d& low,
                      const Eigen::Vector2d& high,
                      double texel_m,
                      Random& random) {
  Canvas c = plain(high.x() - low.x(), high.y() - low.y(), texel_m, 88.0, 16.0, random);
  c.low = low;
  for (double x = low.x() + 1.0; x < high.x(); x += 2.5)
    fill_convex(c, strip({x, low.y()}, {x, high.y()}, 0.03), 50, 0.7);
  for (double y = low.y() + 0.7; y < high.y(); y += 3.3) {
    fill_convex(c, strip({low.x(), y}, {high.x(), y}, 0.10), 150, 0.9);
    fill_convex(c, strip({low.x(), y + 0.07}, {high.x(), y + 0.07}, 0.04), 35, 0.9);
  }
  for (int i = 0; i < static_cast<int>((high - low).prod() * 0.8); ++i)
    fill_convex(
        c,
        rectangle({random.uniform(low.x(), high.x()), random.uniform(low.y(), high.y())},
                  random.uniform(0.0, 3.0), {random.uniform(0.02, 0.3), random.uniform(0.02, 0.1)}),
        random.uniform(40.0, 150.0), 0.5);
  const double spacing = ceiling.lamp_spacing_m;
  const double value = 255.0 * std::min(1.0, ceiling.lamp_brightness);
  for (double x = std::ceil(low.x() / spacing) * spacing; x < high.x(); x += spacing)
    for (double y = std::ceil(low.y() / spacing) * spacing; y < high.y(); y += spacing) {
      fill_convex(c, rectangle({x, y}, 0.0, {2.2, 1.2}), 150, 0.5, 0.8);
      fill_convex(c, rectangle({x, y}, 0.0, {1.3, 0.24}), 60, 1.0);
      if (random.uniform() < 0.93) fill_convex(c, rectangle({x, y}, 0.0, {1.22, 0.16}), value, 1.0);
    }
  return c.image;
}

cv::Mat paint_pillar(double width_m, double height_m, double texel_m, int number, Random& random) {
  Canvas c = plain(width_m, height_m, texel_m, 145.0, 20.0, random);
  add_dirt(c, width_m, height_m, random);
  for (double y = 0.0; y < 0.9; y += 0.3)
    fill_convex(c, {{0, y}, {width_m, y + 0.12}, {width_m, y + 0.27}, {0, y + 0.15}}, 215, 0.9);
  fill_convex(c, strip({0, 1.75}, {width_m, 1.75}, 0.4), 55, 0.95);
  draw_text(c, std::to_string(number), {0.5 * width_m, 1.75}, 0.0, 0.22, 235, 1.0);
  return c.image;
}

cv::Mat paint_sky(Random& random) {
  constexpr int kWide = 4096;
  constexpr int kHigh = 1024;
  cv::Mat sky(kHigh, kWide, CV_8UC1);
  const auto seed = static_cast<std::uint32_t>(random());
  std::vector<double> cosine(kWide);
  std::vector<double> sine(kWide);
  for (std::size_t x = 0; x < kWide; ++x) {
    const double a = static_cast<double>(x) * 2.0 * M_PI / kWide;
    cosine[x] = std::cos(a);
    sine[x] = std::sin(a);
  }
  std::vector<float> u(kWide);
  std::vector<float> v(kWide);
  std::vector<float> cloud(kWide);
  for (int y = 0; y < kHigh; ++y) {
    const double e = 0.5 * M_PI * y / kHigh;
    const double r = 3.0 / (0.25 + e);
    for (std::size_t x = 0; x < kWide; ++x) {
      u[x] = static_cast<float>(r * cosine[x] + 50.0);
      v[x] = static_cast<float>(r * sine[x] + 50.0);
    }
    fractal_noise_at(u, v, 5, seed, cloud);
    for (std::size_t x = 0; x < kWide; ++x)
      sky.at<std::uint8_t>(y, static_cast<int>(x)) = cv::saturate_cast<std::uint8_t>(
          200.0 + 30.0 * e / 1.57 + 60.0 * static_cast<double>(cloud[x]));
  }
  for (int x = 0; x < kWide;) {  // houses and trees on the horizon
    const int wide = 20 + static_cast<int>(random.below(90));
    const int high = 8 + static_cast<int>(random.below(45));
    const bool house = random.below(2) == 0;
    const double tone = random.uniform(50.0, 140.0);
    for (int dx = 0; dx < wide && x + dx < kWide; ++dx) {
      const int top =
          house ? high
                : static_cast<int>(
                      high * (0.6 + 0.4 * static_cast<double>(value_noise(
                                              static_cast<float>(x + dx) * 0.15F, 3.0F, seed))));
      for (int y = 0; y < top; ++y) {
        const bool window = house && (dx % 9) > 3 && (y % 8) > 4;
        sky.at<std::uint8_t>(y, x + dx) = cv::saturate_cast<std::uint8_t>(
            window ? 0.5 * tone
                   : tone + (house ? 0.0
                                   : 25.0 * static_cast<double>(
                                                value_noise(static_cast<float>(x + dx) * 0.4F,
                                                            static_cast<float>(y) * 0.4F, seed))));
      }
    }
    x += wide;
  }
  return sky;
}

}  // namespace roadbook
