#include "sim/world/paint.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace roadbook {
namespace {

/// Calls visit(texel, inside) for all texels near the polygon; `inside` is 0 to 1.
template <typename Visit>
void cover(Canvas& canvas, const Polygon& polygon, double soft_m, Visit&& visit) {
  double area = 0.0;
  Eigen::Vector2d low = polygon.front();
  Eigen::Vector2d high = low;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& a = polygon[i];
    const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
    area += a.x() * b.y() - a.y() * b.x();
    low = low.cwiseMin(a);
    high = high.cwiseMax(a);
  }
  const double side = area >= 0.0 ? 1.0 : -1.0;
  struct Edge {
    Eigen::Vector2d start, along;
    double length;
  };
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d along = polygon[(i + 1) % polygon.size()] - polygon[i];
    edges.push_back({polygon[i], along, along.norm()});
  }
  const double ramp = std::max(soft_m, canvas.texel_m);
  const Eigen::Vector2d first = canvas.texel(low - Eigen::Vector2d::Constant(ramp));
  const Eigen::Vector2d last = canvas.texel(high + Eigen::Vector2d::Constant(ramp));
  const int x0 = std::max(0, static_cast<int>(std::floor(first.x())));
  const int y0 = std::max(0, static_cast<int>(std::floor(first.y())));
  const int x1 = std::min(canvas.image.cols - 1, static_cast<int>(std::ceil(last.x())));
  const int y1 = std::min(canvas.image.rows - 1, static_cast<int>(std::ceil(last.y())));
  for (int y = y0; y <= y1; ++y) {
    std::uint8_t* row = canvas.image.ptr<std::uint8_t>(y);
    for (int x = x0; x <= x1; ++x) {
      const Eigen::Vector2d p = canvas.low + canvas.texel_m * Eigen::Vector2d(x + 0.5, y + 0.5);
      double inside = 1.0;
      for (const Edge& edge : edges) {
        const Eigen::Vector2d to = p - edge.start;
        const double distance =
            side * (edge.along.x() * to.y() - edge.along.y() * to.x()) / edge.length;
        inside = std::min(inside, std::clamp(distance / ramp + 0.5, 0.0, 1.0));
        if (inside <= 0.0) break;
      }
      if (inside > 0.0) visit(row[x], inside);
    }
  }
}

}  // namespace

Polygon strip(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width) {
  const Eigen::Vector2d along = (to - from).normalized();
  const Eigen::Vector2d aside = 0.5 * width * Eigen::Vector2d(-along.y(), along.x());
  return {from - aside, to - aside, to + aside, from + aside};
}

Polygon rectangle(const Eigen::Vector2d& centre, double heading, const Eigen::Vector2d& size) {
  const Eigen::Vector2d half =
      0.5 * size.x() * Eigen::Vector2d(std::cos(heading), std::sin(heading));
  return strip(centre - half, centre + half, size.y());
}

void fill_convex(
    Canvas& canvas, const Polygon& polygon, double value, double opacity, double soft_m) {
  cover(canvas, polygon, soft_m, [&](std::uint8_t& texel, double inside) {
    const double share = inside * opacity;
    texel = cv::saturate_cast<std::uint8_t>(texel + share * (value - texel));
  });
}

void stamp_convex(Canvas& canvas, const Polygon& polygon, std::uint8_t value) {
  cover(canvas, polygon, 0.0, [&](std::uint8_t& texel, double inside) {
    if (inside >= 0.5) texel = value;
  });
}

void shade_convex(Canvas& canvas, const Polygon& polygon, double factor, double soft_m) {
  cover(canvas, polygon, soft_m, [&](std::uint8_t& texel, double inside) {
    texel = cv::saturate_cast<std::uint8_t>(texel * (1.0 + inside * (factor - 1.0)));
  });
}

void draw_text(Canvas& canvas,
               const std::string& text,
               const Eigen::Vector2d& centre,
               double heading,
               double height_m,
               double value,
               double opacity) {
  // Drawn large and level, then turned into place.
  constexpr double kScale = 2.0;
  int baseline = 0;
  const cv::Size size = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, kScale, 5, &baseline);
  cv::Mat stamp = cv::Mat::zeros(size.height + 12, size.width + 12, CV_8UC1);
  cv::putText(stamp, text, {6, size.height + 5}, cv::FONT_HERSHEY_SIMPLEX, kScale, 255, 5,
              cv::LINE_AA);
  const double scale = height_m / canvas.texel_m / size.height;
  const Eigen::Vector2d c = canvas.texel(centre);
  const int reach =
      static_cast<int>(std::ceil(scale * std::hypot(stamp.cols, stamp.rows) / 2.0)) + 2;
  const cv::Rect all(0, 0, canvas.image.cols, canvas.image.rows);
  const cv::Rect box = cv::Rect(static_cast<int>(c.x()) - reach, static_cast<int>(c.y()) - reach,
                                2 * reach, 2 * reach) &
                       all;
  if (box.empty()) return;
  // Rows of a canvas go up in the plane, rows of a stamp go down.
  const double co = std::cos(heading) / scale;
  const double si = std::sin(heading) / scale;
  const double ox = box.x - c.x();
  const double oy = box.y - c.y();
  const cv::Matx23d to_stamp(co, si, co * ox + si * oy + 0.5 * stamp.cols, si, -co,
                             si * ox - co * oy + 0.5 * stamp.rows);
  cv::Mat turned;
  cv::warpAffine(stamp, turned, to_stamp, box.size(), cv::INTER_AREA | cv::WARP_INVERSE_MAP);
  for (int y = 0; y < box.height; ++y)
    for (int x = 0; x < box.width; ++x) {
      std::uint8_t& texel = canvas.image.at<std::uint8_t>(box.y + y, box.x + x);
      const double share = opacity * turned.at<std::uint8_t>(y, x) / 255.0;
      texel = cv::saturate_cast<std::uint8_t>(texel + share * (value - texel));
    }
}

void repeat_bay(const BaySpec& bays, Canvas& canvas) {
  const Eigen::Vector2d first = ((bays.low - canvas.low) / canvas.texel_m).array().round();
  const Eigen::Vector2d size = ((bays.high - bays.low) / canvas.texel_m).array().round();
  const cv::Rect all(0, 0, canvas.image.cols, canvas.image.rows);
  const cv::Rect own = cv::Rect(static_cast<int>(first.x()), static_cast<int>(first.y()),
                                static_cast<int>(size.x()), static_cast<int>(size.y())) &
                       all;
  const cv::Mat look = canvas.image(own).clone();
  for (int bay = 1; bay < bays.count; ++bay) {
    const int shift = static_cast<int>(std::lround(bay * bays.step_m() / canvas.texel_m));
    const cv::Rect there = (own + cv::Point(shift, 0)) & all;
    if (there.empty()) continue;
    look(cv::Rect(0, 0, there.width, there.height)).copyTo(canvas.image(there));
  }
}

cv::Mat speckle_tile(
    int size, int grains, int smallest, int largest, double contrast, Random& random) {
  cv::Mat tile(size, size, CV_32FC1, cv::Scalar(0));
  for (int g = 0; g < grains; ++g) {
    const double cx = random.uniform(0.0, size);
    const double cy = random.uniform(0.0, size);
    const double radius = random.uniform(smallest, largest);
    const double stretch = random.uniform(0.6, 1.6);
    const double value = contrast * random.normal();
    const int reach = static_cast<int>(std::ceil(radius * 1.7)) + 1;
    for (int dy = -reach; dy <= reach; ++dy)
      for (int dx = -reach; dx <= reach; ++dx) {
        const double u = dx * stretch;
        const double v = dy / stretch;
        if (u * u + v * v > 1.001 * radius * radius) continue;  // most: spares the exact distance
        const double distance = std::hypot(u, v) / radius;
        if (distance >= 1.0) continue;
        const int x = (static_cast<int>(cx) + dx + size) & (size - 1);
        const int y = (static_cast<int>(cy) + dy + size) & (size - 1);
        float& texel = tile.at<float>(y, x);
        texel = static_cast<float>(texel + (value - texel) * std::min(1.0, 3.0 * (1.0 - distance)));
      }
  }
  tile -= cv::mean(tile)[0];
  cv::Mat result;
  tile.convertTo(result, CV_8U, 1.0, 128.0);
  return result;
}

}  // namespace roadbook
