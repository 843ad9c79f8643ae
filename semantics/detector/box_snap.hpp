#pragma once

#include <cstdint>
#include <vector>

#include "semantics/oriented_box.hpp"
#include "semantics/overhead/ground_image.hpp"

namespace roadbook {

// Boxes put on the lines that bound them. A detector finds a thing to within the steps of its
// search; where things are bounded by bright paint, as parking spaces are, the paint tells the
// rest.

/// A picture of the ground made ready to look for paint in: made once, asked by many boxes.
class PaintPicture {
 public:
  static constexpr std::int16_t kUnseen = 1000;  ///< above all greys

  /// Not explicit: for a single box the picture itself serves.
  PaintPicture(const GroundImage& image);

  [[nodiscard]] const cv::Mat& values() const { return values_; }  ///< 16 bit: grey, or kUnseen
  [[nodiscard]] Eigen::Vector2d pixel_of(const Eigen::Vector2d& p) const {
    return place_.pixel_of(p);
  }

 private:
  GroundImage place_;  ///< without its pixels
  cv::Mat values_;
};

struct SnapOptions {
  double reach_m = 0.45;   ///< farthest a side moves: well below half the width of a space
  double turn_rad = 0.10;  ///< farthest it turns
  double step_m = 0.02;
  double line_m = 0.20;       ///< from a line's middle to the ground beside it, in whole steps
  double full_contrast = 30;  ///< grey levels of 255 that count as paint for sure
  double least_paint = 0.30;  ///< share of a side along which there must be paint
  double size_change = 0.12;  ///< largest relative change of a side's length

  /// Throws InvalidOption.
  void check() const;
};

/// Paint along the better of both long sides, 0 to 1.
[[nodiscard]] double paint_along(const PaintPicture& picture,
                                 const OrientedBox& box,
                                 const SnapOptions& options = {});

/// The box with its sides on the paint near them: long sides first, they also turn it, then the
/// short ones. A side without paint goes with the opposite one; a box without any stays as it is.
[[nodiscard]] OrientedBox snapped(const PaintPicture& picture,
                                  const OrientedBox& box,
                                  const SnapOptions& options = {});
/// The same of many, on `num_threads` threads (0: all cores).
[[nodiscard]] std::vector<OrientedBox> all_snapped(const PaintPicture& picture,
                                                   std::vector<OrientedBox> boxes,
                                                   int num_threads,
                                                   const SnapOptions& options = {});

}  // namespace roadbook
