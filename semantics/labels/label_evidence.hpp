#pragma once

#include <functional>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "semantics/labels/labels.hpp"

namespace roadbook {

// Checks whether the paint of a label still exists: searches its outline in images of another
// session.
//
// Paint is a bright line between darker ground on both sides. A point of the outline is used if the
// label's own image shows paint there. Each such point of the other image is classified as paint,
// plain ground, or neither. Neither means that something covers the point (a parked car), which is
// no evidence. The search allows a shift up to the error of the map.

enum class EvidenceStatus {
  kFound,    ///< enough of the paint was found
  kGone,     ///< plain ground where the paint was
  kCovered,  ///< neither paint nor plain ground
  kNoPaint,  ///< the label's own image shows no paint along the outline: nothing to search for
  kUnseen    ///< no image shows the outline, or the label's own image is not available
};

struct LabelEvidence {
  std::int64_t id = 0;
  EvidenceStatus status = EvidenceStatus::kUnseen;
  LabelAnchor view;    ///< the view in which most paint was found
  double paint = 0.0;  ///< share of the outline's paint found in `view`, 0 to 1
  double bare = 0.0;   ///< largest share that is plain ground, over all views
  /// Position of the paint in `view` minus its position by the map, map frame [m]. If all paint
  /// runs in one direction, only the component across it is measured.
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();
};

struct EvidenceOptions {
  double max_range_m = 9.0;      ///< largest distance from camera to label
  double search_m = 1.0;         ///< largest shift; less than half the width of a parking space
  int views = 4;                 ///< number of views used per session, the most central ones
  double least_contrast = 12.0;  ///< of paint against adjacent ground, grey levels of 255
  double least_paint = 0.55;     ///< share of paint for kFound
  double least_bare = 0.6;       ///< share of plain ground for kGone
};

/// Returns the grey 8-bit image of a keyframe and camera; empty if it is not available.
using KeyframeImages = std::function<cv::Mat(int keyframe, int camera)>;

/// Searches the paint of one label in the images of `session`, without the label's own keyframe.
[[nodiscard]] LabelEvidence look_again(const Map& map,
                                       const Label& label,
                                       int session,
                                       const KeyframeImages& images,
                                       const EvidenceOptions& options = {});

/// Converts the evidence for a found label into a further measurement of its position
/// (Label::sightings). If all paint runs in one direction, the component along it is taken from the
/// map. Throws InvalidOption if the map has no pose for one of the images.
[[nodiscard]] LabelSighting sighting_of(const Map& map,
                                        const Label& label,
                                        const LabelEvidence& evidence);

}  // namespace roadbook
