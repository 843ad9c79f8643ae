#pragma once

#include <functional>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "semantics/labels/labels.hpp"

namespace roadbook {

// Whether what a label shows is still painted on the ground: its outline in the image it hangs on,
// looked for in images of a later session.
//
// Paint is a bright line between darker ground on both sides. Where the label's own image has it
// along the outline, another image of the same place must have it too, at most so far away as the
// map may be wrong. Where it has plain ground instead, the paint is gone; where it has neither,
// something stands before it (a parked car), which says nothing.

enum class EvidenceStatus {
  kFound,    ///< the paint is there
  kGone,     ///< plain ground where it was
  kCovered,  ///< neither
  kNoPaint,  ///< the label's own image has no paint along its outline: nothing to look for
  kUnseen    ///< no image shows it, or its own is not at hand
};

struct LabelEvidence {
  std::int64_t id = 0;
  EvidenceStatus status = EvidenceStatus::kUnseen;
  LabelAnchor view;    ///< the image looked into, of the views the one that shows most
  double paint = 0.0;  ///< share of the outline's paint found there, 0 to 1
  double bare = 0.0;   ///< share that is plain ground there
  /// Where the paint lies in that image, relative to where the map has it (map frame) [m]. Where
  /// all paint runs in one direction, only what is across it.
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();
};

struct EvidenceOptions {
  double max_range_m = 9.0;      ///< of a view's camera from the label
  double search_m = 1.0;         ///< largest shift: below half of what spaces are wide
  int views = 4;                 ///< of a session, the most central ones
  double least_contrast = 12.0;  ///< of paint against the ground beside it, grey levels of 255
  double least_paint = 0.55;     ///< share that counts as found
  double least_bare = 0.6;       ///< share that counts as gone
};

/// Grey 8-bit image of a keyframe and camera; empty where it is not at hand.
using KeyframeImages = std::function<cv::Mat(int keyframe, int camera)>;

/// Looks for one label in the images of `session`; its own keyframe is left out.
[[nodiscard]] LabelEvidence look_again(const Map& map,
                                       const Label& label,
                                       int session,
                                       const KeyframeImages& images,
                                       const EvidenceOptions& options = {});

/// What a found label says about its place, as a further anchor (Label::sightings); along paint
/// that runs in one direction it agrees with the map. Throws InvalidOption for evidence of another
/// map.
[[nodiscard]] LabelSighting sighting_of(const Map& map,
                                        const Label& label,
                                        const LabelEvidence& evidence);

}  // namespace roadbook
