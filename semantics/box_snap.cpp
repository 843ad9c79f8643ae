#include "semantics/box_snap.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.hpp"

namespace roadbook {
namespace {

// Grey value at a place, of the nearest pixel; empty where nothing was seen.
std::optional<double> grey_at(const GroundImage& image, const Eigen::Vector2d& p) {
  const Eigen::Vector2d pixel = image.pixel_of(p);
  const int column = static_cast<int>(std::lround(pixel.x()));
  const int row = static_cast<int>(std::lround(pixel.y()));
  if (column < 0 || row < 0 || column >= image.grey.cols || row >= image.grey.rows ||
      image.seen.at<std::uint8_t>(row, column) == 0)
    return std::nullopt;
  return image.grey.at<std::uint8_t>(row, column);
}

struct Side {
  Eigen::Vector2d middle;
  Eigen::Vector2d along;    ///< unit
  Eigen::Vector2d outward;  ///< unit
  double length_m = 0.0;
};

// Mean share of paint along a side that is moved outward by `offset`.
double paint_of(const GroundImage& image,
                const Side& side,
                double offset,
                const SnapOptions& options) {
  constexpr int kPoints = 32;
  double sum = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const double at = ((i + 0.5) / kPoints - 0.5) * side.length_m;
    const Eigen::Vector2d p = side.middle + at * side.along + offset * side.outward;
    const auto here = grey_at(image, p);
    const auto in = grey_at(image, p - options.line_m * side.outward);
    const auto out = grey_at(image, p + options.line_m * side.outward);
    if (here && in && out)
      sum += std::clamp((*here - std::max(*in, *out)) / options.full_contrast, 0.0, 1.0);
  }
  return sum / kPoints;
}

struct Fit {
  double offset = 0.0;
  double paint = 0.0;
};

// The offset with most paint, the smallest of equal ones.
Fit best_offset(const GroundImage& image, const Side& side, const SnapOptions& options) {
  Fit best{0.0, paint_of(image, side, 0.0, options)};
  const int n = static_cast<int>(std::lround(options.reach_m / options.step_m));
  for (int i = 1; i <= n; ++i)
    for (const double offset : {i * options.step_m, -i * options.step_m}) {
      const double paint = paint_of(image, side, offset, options);
      if (paint > best.paint) best = {offset, paint};
    }
  return best;
}

Side side_of(const OrientedBox& box, bool is_long, double sign) {
  const Eigen::Vector2d ahead(std::cos(box.heading), std::sin(box.heading));
  const Eigen::Vector2d left(-ahead.y(), ahead.x());
  if (is_long)
    return {box.centre + 0.5 * sign * box.width_m * left, ahead, sign * left, box.length_m};
  return {box.centre + 0.5 * sign * box.length_m * ahead, left, sign * ahead, box.width_m};
}

struct PairFit {
  Fit plus;
  Fit minus;
  [[nodiscard]] double paint() const { return plus.paint + minus.paint; }
};

// Both sides of a pair; one without paint, or of another size than can be, goes with the other.
PairFit fit_pair(const GroundImage& image,
                 const OrientedBox& box,
                 bool is_long,
                 const SnapOptions& options) {
  PairFit fit{best_offset(image, side_of(box, is_long, 1.0), options),
              best_offset(image, side_of(box, is_long, -1.0), options)};
  for (Fit* side : {&fit.plus, &fit.minus})
    if (side->paint < options.least_paint) *side = {0.0, 0.0};
  const double size = is_long ? box.width_m : box.length_m;
  const bool fits = std::abs(fit.plus.offset + fit.minus.offset) <= options.size_change * size;
  if (fit.plus.paint > 0.0 && fit.minus.paint > 0.0 && fits) return fit;
  if (fit.plus.paint >= fit.minus.paint)
    fit.minus = {-fit.plus.offset, 0.0};
  else
    fit.plus = {-fit.minus.offset, 0.0};
  return fit;
}

void apply(OrientedBox& box, bool is_long, const PairFit& fit) {
  const Side plus = side_of(box, is_long, 1.0);
  box.centre += 0.5 * (fit.plus.offset - fit.minus.offset) * plus.outward;
  (is_long ? box.width_m : box.length_m) += fit.plus.offset + fit.minus.offset;
}

}  // namespace

void SnapOptions::check() const {
  if (!(reach_m > 0.0 && reach_m <= 2.0))
    throw InvalidOption("reach_m", std::to_string(reach_m), "above 0 to 2");
  if (!(step_m > 0.0 && step_m <= reach_m))
    throw InvalidOption("step_m", std::to_string(step_m), "above 0 to reach_m");
}

double paint_along(const GroundImage& image, const OrientedBox& box, const SnapOptions& options) {
  options.check();
  return std::max(paint_of(image, side_of(box, true, 1.0), 0.0, options),
                  paint_of(image, side_of(box, true, -1.0), 0.0, options));
}

OrientedBox snapped(const GroundImage& image, const OrientedBox& box, const SnapOptions& options) {
  options.check();
  constexpr int kTurns = 10;  // each way
  OrientedBox best = box;
  PairFit most = fit_pair(image, box, true, options);
  for (int i = 1; i <= kTurns; ++i)
    for (const double sign : {1.0, -1.0}) {
      OrientedBox turned = box;
      turned.heading += sign * i * options.turn_rad / kTurns;
      const PairFit fit = fit_pair(image, turned, true, options);
      if (fit.paint() <= most.paint()) continue;
      most = fit;
      best = turned;
    }
  if (most.paint() > 0.0)
    apply(best, true, most);
  else
    best = box;
  const PairFit ends = fit_pair(image, best, false, options);
  if (ends.paint() > 0.0) apply(best, false, ends);
  return best;
}

}  // namespace roadbook
