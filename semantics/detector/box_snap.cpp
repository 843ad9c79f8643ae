#include "semantics/detector/box_snap.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/parallel.hpp"

namespace roadbook {
namespace {

struct Side {
  Eigen::Vector2d middle;
  Eigen::Vector2d along;    ///< unit
  Eigen::Vector2d outward;  ///< unit
  double length_m = 0.0;
};

constexpr int kPoints = 32;  // along a side

// The range of positions across a side: offsets in steps, outward positive.
struct Reach {
  int offsets = 0;  ///< largest offset, each way
  int line = 0;     ///< from a line's middle to the ground next to it
  [[nodiscard]] int all() const { return offsets + line; }
};

Reach reach_of(const SnapOptions& options, double reach_m) {
  return {static_cast<int>(std::lround(reach_m / options.step_m)),
          std::max(1, static_cast<int>(std::lround(options.line_m / options.step_m)))};
}

// Grey values on straight lines across a side: from the nearest pixel; kUnseen where no camera saw
// the ground.
class Crossings {
 public:
  Crossings(const PaintPicture& picture, const Side& side, const Reach& reach, double step_m)
      : values_(picture.values()), count_(2 * reach.all() + 1) {
    const Eigen::Vector2d first = side.middle - (0.5 - 0.5 / kPoints) * side.length_m * side.along -
                                  reach.all() * step_m * side.outward;
    first_ = picture.pixel_of(first);
    along_ = picture.pixel_of(first + side.length_m / kPoints * side.along) - first_;
    step_ = picture.pixel_of(first + step_m * side.outward) - first_;
    inside_ = true;  // a convex image contains the side if it contains its corners
    for (const int i : {0, kPoints - 1})
      for (const int k : {0, count_ - 1}) inside_ = inside_ && holds(at(i, k));
  }
  /// Reads the line at one point of the side, from the innermost value outward.
  void read(int point, std::vector<float>& greys) const {
    const Eigen::Vector2d begin = at(point, 0);
    for (int k = 0; k < count_; ++k) {
      const double x = begin.x() + k * step_.x();
      const double y = begin.y() + k * step_.y();
      if (!inside_ && !holds({x, y})) {
        greys[static_cast<std::size_t>(k)] = PaintPicture::kUnseen;
        continue;
      }
      greys[static_cast<std::size_t>(k)] =
          values_.at<std::int16_t>(static_cast<int>(y + 0.5), static_cast<int>(x + 0.5));
    }
  }

 private:
  [[nodiscard]] Eigen::Vector2d at(int point, int k) const {
    return first_ + point * along_ + k * step_;
  }
  [[nodiscard]] bool holds(const Eigen::Vector2d& pixel) const {
    return pixel.x() > -0.5 && pixel.y() > -0.5 && pixel.x() < values_.cols - 0.501 &&
           pixel.y() < values_.rows - 0.501;
  }

  const cv::Mat& values_;
  int count_;
  Eigen::Vector2d first_;
  Eigen::Vector2d along_;
  Eigen::Vector2d step_;
  bool inside_ = false;
};

// Mean share of paint along a side for each offset, the innermost offset first.
std::vector<float> paint_across(const PaintPicture& picture,
                                const Side& side,
                                const Reach& reach,
                                const SnapOptions& options) {
  const Crossings crossings(picture, side, reach, options.step_m);
  const auto line = static_cast<std::size_t>(reach.line);
  const auto full = static_cast<float>(options.full_contrast);
  std::vector<float> greys(2 * static_cast<std::size_t>(reach.all()) + 1);
  std::vector<float> paint(2 * static_cast<std::size_t>(reach.offsets) + 1, 0.0F);
  for (int point = 0; point < kPoints; ++point) {
    crossings.read(point, greys);
    for (std::size_t k = 0; k < paint.size(); ++k) {
      // Unseen ground counts as brighter than any paint, but it is not paint itself.
      const float here = greys[k + line] < PaintPicture::kUnseen ? greys[k + line] : 0.0F;
      const float contrast = here - std::max(greys[k], greys[k + 2 * line]);
      paint[k] += std::clamp(contrast, 0.0F, full);
    }
  }
  for (float& p : paint) p /= full * kPoints;
  return paint;
}

struct Fit {
  double offset = 0.0;
  double paint = 0.0;
};

// The offset with most paint; of equal offsets, the smallest.
Fit best_offset(const PaintPicture& picture, const Side& side, const SnapOptions& options) {
  const Reach reach = reach_of(options, options.reach_m);
  const std::vector<float> paint = paint_across(picture, side, reach, options);
  const auto at = [&](int i) { return paint[static_cast<std::size_t>(reach.offsets + i)]; };
  int best = 0;
  for (int i = 1; i <= reach.offsets; ++i)
    for (const int offset : {i, -i})
      if (at(offset) > at(best)) best = offset;
  return {best * options.step_m, at(best)};
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

// Fits both sides of a pair. A side without paint, or with an impossible size, moves with the other
// side.
PairFit fit_pair(const PaintPicture& picture,
                 const OrientedBox& box,
                 bool is_long,
                 const SnapOptions& options) {
  PairFit fit{best_offset(picture, side_of(box, is_long, 1.0), options),
              best_offset(picture, side_of(box, is_long, -1.0), options)};
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

PaintPicture::PaintPicture(const GroundImage& image) {
  place_.corner = image.corner;
  place_.resolution_m = image.resolution_m;
  image.grey.convertTo(values_, CV_16S);
  values_.setTo(kUnseen, image.seen == 0);
}

void SnapOptions::check() const {
  if (!(reach_m > 0.0 && reach_m <= 2.0))
    throw InvalidOption("reach_m", std::to_string(reach_m), "above 0 to 2");
  if (!(step_m > 0.0 && step_m <= reach_m))
    throw InvalidOption("step_m", std::to_string(step_m), "above 0 to reach_m");
}

double paint_along(const PaintPicture& picture,
                   const OrientedBox& box,
                   const SnapOptions& options) {
  options.check();
  const auto along = [&](double sign) {
    return paint_across(picture, side_of(box, true, sign), reach_of(options, 0.0), options).front();
  };
  return std::max(along(1.0), along(-1.0));
}

OrientedBox snapped(const PaintPicture& picture,
                    const OrientedBox& box,
                    const SnapOptions& options) {
  options.check();
  constexpr int kTurns = 10;  // each way
  OrientedBox best = box;
  PairFit most = fit_pair(picture, box, true, options);
  for (int i = 1; i <= kTurns; ++i)
    for (const double sign : {1.0, -1.0}) {
      OrientedBox turned = box;
      turned.heading += sign * i * options.turn_rad / kTurns;
      const PairFit fit = fit_pair(picture, turned, true, options);
      if (fit.paint() <= most.paint()) continue;
      most = fit;
      best = turned;
    }
  if (most.paint() > 0.0)
    apply(best, true, most);
  else
    best = box;
  const PairFit ends = fit_pair(picture, best, false, options);
  if (ends.paint() > 0.0) apply(best, false, ends);
  return best;
}

std::vector<OrientedBox> all_snapped(const PaintPicture& picture,
                                     std::vector<OrientedBox> boxes,
                                     int num_threads,
                                     const SnapOptions& options) {
  parallel_for(boxes.size(), num_threads,
               [&](std::size_t i) { boxes[i] = snapped(picture, boxes[i], options); });
  return boxes;
}

}  // namespace roadbook
