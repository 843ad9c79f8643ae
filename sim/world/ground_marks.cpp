#include "sim/world/ground_marks.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/world/path.hpp"

namespace roadbook {
namespace {

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

}  // namespace

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

}  // namespace roadbook
