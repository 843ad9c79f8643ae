#pragma once

#include <cstdint>
#include <vector>

#include "semantics/oriented_box.hpp"
#include "semantics/overhead/ground_image.hpp"

namespace roadbook {

// Aligns boxes with the painted lines that bound them. A search finds a box to within the steps of
// its grid; the paint gives the exact position of parking spaces.

/// An overhead image prepared for the search for paint; made once for many boxes.
class PaintPicture {
 public:
  static constexpr std::int16_t kUnseen = 1000;  ///< larger than every grey value

  /// Implicit, so that a GroundImage can be passed for a single box.
  PaintPicture(const GroundImage& image);

  [[nodiscard]] const cv::Mat& values() const { return values_; }  ///< 16 bit: grey, or kUnseen
  [[nodiscard]] Eigen::Vector2d pixel_of(const Eigen::Vector2d& p) const {
    return place_.pixel_of(p);
  }

 private:
  GroundImage place_;  ///< position and resolution; without pixels
  cv::Mat values_;
};

struct SnapOptions {
  double reach_m = 0.45;   ///< largest shift of a side; well below half the width of a space
  double turn_rad = 0.10;  ///< largest turn
  double step_m = 0.02;
  double line_m = 0.20;       ///< from the middle of a line to the adjacent ground
  double full_contrast = 30;  ///< contrast of certain paint, grey levels of 255
  double least_paint = 0.30;  ///< smallest share of a side that must be painted
  double size_change = 0.12;  ///< largest relative change of a side's length

  /// Throws InvalidOption.
  void check() const;
};

/// Share of paint along the better of the two long sides, 0 to 1.
[[nodiscard]] double paint_along(const PaintPicture& picture,
                                 const OrientedBox& box,
                                 const SnapOptions& options = {});

/// Returns the box with its sides moved to the paint near them: first the long sides, which also
/// turn the box, then the short sides. A side without paint moves with the opposite side. A box
/// without paint is returned unchanged.
[[nodiscard]] OrientedBox snapped(const PaintPicture& picture,
                                  const OrientedBox& box,
                                  const SnapOptions& options = {});
/// Same for many boxes, on `num_threads` threads (0: all cores).
[[nodiscard]] std::vector<OrientedBox> all_snapped(const PaintPicture& picture,
                                                   std::vector<OrientedBox> boxes,
                                                   int num_threads,
                                                   const SnapOptions& options = {});

}  // namespace roadbook
