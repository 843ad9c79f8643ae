#include "sim/ground_marks.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/mesh.hpp"
#include "sim/noise_row.hpp"
#include "sim/path.hpp"

namespace roadbook {
namespace {

double ares(const GroundSpec& ground) { return (ground.high - ground.low).prod() / 100.0; }

Eigen::Vector2d anywhere(const GroundSpec& ground, Random& random) {
  const double x = random.uniform(ground.low.x(), ground.high.x());
  return {x, random.uniform(ground.low.y(), ground.high.y())};
}

Polygon blob(const Eigen::Vector2d& centre, double radius, Random& random) {
  Polygon polygon;
  for (int i = 0; i < 9; ++i) {
    const double a = i * 2.0 * std::numbers::pi / 9.0;
    polygon.push_back(centre + radius * random.uniform(0.85, 1.15) *
                                   Eigen::Vector2d(std::cos(a), std::sin(a)));
  }
  return polygon;
}

void paint_crack(Canvas& ground, const Eigen::Vector2d& start, Random& random) {
  Eigen::Vector2d at = start;
  double heading = random.uniform(0.0, 2.0 * std::numbers::pi);
  const int pieces = 10 + static_cast<int>(random.below(30));
  const double width = random.uniform(0.006, 0.018);
  for (int i = 0; i < pieces; ++i) {
    heading += 0.45 * random.normal();
    const Eigen::Vector2d next =
        at + random.uniform(0.04, 0.16) * Eigen::Vector2d(std::cos(heading), std::sin(heading));
    fill_convex(ground, strip(at, next, width), 30, 0.75);
    at = next;
  }
}

/// Two dark bands where tyres have run, strongest in bends.
void paint_tyre_marks(const Scenario& scenario, Canvas& ground, Random& random) {
  for (const LaneSpec& lane : scenario.lanes) {
    const DrivingLine line(lane.points, scenario.vehicle.turn_radius_m, lane.closed);
    const int marks = 3 + static_cast<int>(line.length_m() / 12.0);
    for (int m = 0; m < marks; ++m) {
      const double start = random.uniform(0.0, line.length_m());
      const double length = random.uniform(1.5, 7.0);
      const double aside = random.uniform(-0.5, 0.5) + (random.below(2) == 0 ? 0.75 : -0.75);
      const double bend = 0.02 * random.normal();
      const double opacity = random.uniform(0.08, 0.3);
      const auto point = [&](double s) {
        const double h = line.heading(s);
        return Eigen::Vector2d(line.at(s) + (aside + bend * (s - start) * (s - start)) *
                                                Eigen::Vector2d(-std::sin(h), std::cos(h)));
      };
      for (double s = start; s < start + length; s += 0.25)
        fill_convex(ground, strip(point(s), point(s + 0.25), 0.17), 25, opacity, 0.03);
    }
  }
}

void paint_line(Canvas& mask, const Polygon& polygon, double paint, double wear) {
  // Coverage is exact; brightness and wear fill the same texels a little wider.
  Canvas channel = mask;
  Eigen::Vector2d low = polygon[0];
  Eigen::Vector2d high = polygon[0];
  for (const auto& p : polygon) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Eigen::Vector2d first = mask.texel(low);
  const Eigen::Vector2d last = mask.texel(high);
  const cv::Rect box =
      cv::Rect(cv::Point(static_cast<int>(first.x()) - 2, static_cast<int>(first.y()) - 2),
               cv::Point(static_cast<int>(last.x()) + 4, static_cast<int>(last.y()) + 4)) &
      cv::Rect(0, 0, mask.image.cols, mask.image.rows);
  if (box.empty()) return;
  channel.image = cv::Mat::zeros(box.size(), CV_8UC1);
  channel.low = mask.low + mask.texel_m * Eigen::Vector2d(box.x, box.y);
  fill_convex(channel, polygon, 255.0, 1.0);
  for (int y = 0; y < box.height; ++y)
    for (int x = 0; x < box.width; ++x) {
      const std::uint8_t cover = channel.image.at<std::uint8_t>(y, x);
      if (cover == 0) continue;
      auto& texel = mask.image.at<cv::Vec3b>(box.y + y, box.x + x);
      texel[0] = std::max(texel[0], cover);
      texel[1] = cv::saturate_cast<std::uint8_t>(255.0 * paint);
      texel[2] = cv::saturate_cast<std::uint8_t>(255.0 * wear);
    }
}

void paint_crossing(const CrossingSpec& crossing, Canvas& mask) {
  const double length = (crossing.to - crossing.from).norm();
  const Eigen::Vector2d along = (crossing.to - crossing.from) / length;
  const Eigen::Vector2d aside(-along.y(), along.x());
  const double half = 0.5 * crossing.width_m;
  if (crossing.style == CrossingStyle::kZebra) {
    for (double s = 0.0; s + 0.5 <= length; s += 1.0)
      paint_line(
          mask,
          strip(crossing.from + s * along, crossing.from + (s + 0.5) * along, crossing.width_m),
          0.9, crossing.wear);
    return;
  }
  for (const double e : {-half, half})
    paint_line(mask, strip(crossing.from + e * aside, crossing.to + e * aside, 0.12), 0.75,
               crossing.wear);
  for (double s = 0.0; s + crossing.width_m <= length; s += 0.7)
    paint_line(mask,
               strip(crossing.from + s * along - half * aside,
                     crossing.from + (s + crossing.width_m) * along + half * aside, 0.12),
               0.75, crossing.wear);
}

void paint_number(const ParkingSpace& space, Canvas& mask) {
  if (space.number == 0) return;
  Canvas stamp{cv::Mat::zeros(160, 160, CV_8UC1), Eigen::Vector2d::Zero(), mask.texel_m};
  const Eigen::Vector2d out(std::cos(space.heading), std::sin(space.heading));
  const Eigen::Vector2d centre =
      space.centre + (0.5 * (space.corners[3] - space.corners[0]).norm() - 0.7) * out;
  const Eigen::Vector2d corner = mask.texel(centre) - Eigen::Vector2d::Constant(80.0);
  const int x0 = static_cast<int>(std::floor(corner.x()));
  const int y0 = static_cast<int>(std::floor(corner.y()));
  stamp.low = mask.low + mask.texel_m * Eigen::Vector2d(x0, y0);
  // Read by someone who drives in.
  draw_text(stamp, std::to_string(space.number), centre, space.heading + 0.5 * std::numbers::pi,
            0.32, 255, 1.0);
  const cv::Rect all(0, 0, mask.image.cols, mask.image.rows);
  for (int y = 0; y < 160; ++y)
    for (int x = 0; x < 160; ++x) {
      const std::uint8_t cover = stamp.image.at<std::uint8_t>(y, x);
      if (cover == 0 || !all.contains({x0 + x, y0 + y})) continue;
      mask.image.at<cv::Vec3b>(y0 + y, x0 + x) = {cover, 190, 60};
    }
}

/// Brightness of what is not asphalt; the borders are frayed by noise.
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

void paint_wear(const Scenario& scenario, const Layout& layout, Canvas& ground) {
  const GroundSpec& spec = scenario.ground;
  Random random(scenario.seed, "wear");
  const auto many = [&](double per_are) { return static_cast<int>(ares(spec) * per_are + 0.5); };
  for (int i = many(0.35 * spec.cracks_per_are); i > 0; --i)
    fill_convex(ground,
                rectangle(anywhere(spec, random), random.uniform(0.0, 0.3),
                          {random.uniform(0.5, 2.5), random.uniform(0.4, 1.6)}),
                255.0 * spec.brightness * random.uniform(0.7, 1.25), 0.45);
  for (int i = many(spec.cracks_per_are); i > 0; --i)
    paint_crack(ground, anywhere(spec, random), random);
  for (int i = many(0.3 * spec.cracks_per_are); i > 0; --i) {
    const Eigen::Vector2d a = anywhere(spec, random);
    const double heading = random.below(2) == 0 ? 0.02 : 1.59;
    fill_convex(
        ground,
        strip(a,
              a + random.uniform(1.0, 5.0) * Eigen::Vector2d(std::cos(heading), std::sin(heading)),
              0.03),
        35, 0.8);
  }
  paint_tyre_marks(scenario, ground, random);
  for (const ParkingSpace& space : layout.spaces)  // engines drip where engines stand
    for (int i = 0; i < 4; ++i)
      fill_convex(ground,
                  blob(space.centre + Eigen::Vector2d(0.7 * random.normal(), 0.7 * random.normal()),
                       random.uniform(0.04, 0.25), random),
                  25, random.uniform(0.1, 0.45), 0.04);
}

void paint_markings(const Scenario& scenario, const Layout& layout, Canvas& mask) {
  for (const SpaceLine& line : layout.lines)
    if (!line.column)
      paint_line(mask, strip(line.front, line.back, line.width_m), line.paint, line.wear);
  for (const SpaceRowSpec& row : scenario.rows) {
    const Eigen::Vector2d along = (row.to - row.from).normalized();
    const Eigen::Vector2d back = row.depth_m * Eigen::Vector2d(-along.y(), along.x());
    paint_line(mask, strip(row.from + back, row.to + back, row.line_width_m), row.paint, row.wear);
  }
  for (const ParkingSpace& space : layout.spaces) paint_number(space, mask);
  for (const CrossingSpec& crossing : scenario.crossings) paint_crossing(crossing, mask);
  if (scenario.ground.hinge && scenario.ground.hinge->drain_width_m > 0.0) {
    const HingeSpec& h = *scenario.ground.hinge;
    const Eigen::Vector2d along = (h.to - h.from).normalized();
    paint_line(mask, strip(h.from, h.to, h.drain_width_m), 0.13, 0.0);
    for (double s = 0.05; s < (h.to - h.from).norm(); s += 0.1)
      paint_line(mask,
                 strip(h.from + s * along, h.from + (s + 0.04) * along, 0.7 * h.drain_width_m),
                 0.45, 0.1);
  }
  if (scenario.ground.gravel_edge_m <= 0.0) return;
  for (const LaneSpec& lane : scenario.lanes) {  // a country road: edge lines and a dashed middle
    const DrivingLine line(lane.points, scenario.vehicle.turn_radius_m, lane.closed);
    // Pieces overlap by a texel: coverage is soft at their ends.
    const double piece = 0.5 + scenario.ground.texel_m;
    for (double s = 0.0; s < line.length_m(); s += 0.5) {
      const double h0 = line.heading(s), h1 = line.heading(s + piece);
      const Eigen::Vector2d n0(-std::sin(h0), std::cos(h0)), n1(-std::sin(h1), std::cos(h1));
      for (const double e : {-0.5 * lane.width_m + 0.25, 0.5 * lane.width_m - 0.25})
        paint_line(mask, strip(line.at(s) + e * n0, line.at(s + piece) + e * n1, 0.15), 0.85, 0.35);
      if (std::fmod(s, 9.0) < 3.0)
        paint_line(mask, strip(line.at(s), line.at(s + piece), 0.13), 0.85, 0.35);
    }
  }
}

void paint_dirt(const Scenario& scenario, Canvas& ground) {
  const GroundSpec& spec = scenario.ground;
  Random random(scenario.seed, "dirt");
  const int count = static_cast<int>(ares(spec) * spec.stains_per_are + 0.5);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d at = anywhere(spec, random);
    const double what = random.uniform();
    if (what < 0.45)
      fill_convex(ground, blob(at, random.uniform(0.012, 0.035), random),
                  random.below(2) == 0 ? 30 : 175, random.uniform(0.4, 0.8));
    else if (what < 0.75)
      fill_convex(ground, blob(at, random.uniform(0.05, 0.3), random), 35, random.uniform(0.1, 0.4),
                  0.03);
    else
      fill_convex(ground,
                  rectangle(at, random.uniform(0.0, 3.1),
                            {random.uniform(0.03, 0.12), random.uniform(0.02, 0.06)}),
                  random.uniform(60.0, 220.0), 0.7);
  }
}

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
