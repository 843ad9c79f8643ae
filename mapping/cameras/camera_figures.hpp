#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "drive/drive.hpp"
#include "mapping/joined_tracks.hpp"
#include "mapping/optimisation/bundle_adjustment.hpp"
#include "mapping/pipeline/bundle_problem.hpp"

namespace roadbook {

// What each camera contributed to a map. The figures are those of the last bundle adjustment;
// pixels are those of the full-size image.

/// Mean of residuals (measured minus predicted pixel) over the corners that fit.
struct MeanResidual {
  double radial_px = 0.0;      ///< away from the principal point
  double tangential_px = 0.0;  ///< clockwise around the principal point, as the image is seen
  double horizontal_px = 0.0;  ///< to the right
  double vertical_px = 0.0;    ///< down
};

struct CameraFigures {
  std::string session;
  std::string camera;
  std::size_t keyframes = 0;             ///< with an image of this camera
  std::size_t corners = 0;               ///< key points that took part
  std::size_t landmarks = 0;             ///< with a key point that fits
  std::optional<double> fit_share;       ///< of the corners; empty without any
  std::optional<double> views;           ///< fitting corners a keyframe; empty without any
  std::optional<MeanResidual> residual;  ///< empty without fitting corners
  std::optional<double> paired_share;    ///< of its images at the time of another camera's image
  std::optional<double> late_s;  ///< median time from another camera's nearest image to an unpaired
                                 ///< one; empty if most are paired
};

/// Figures of every camera of every drive, in their order. `stage` and `result` as adjusted.
[[nodiscard]] std::vector<CameraFigures> camera_figures(const MappingInput& input,
                                                        const std::vector<Drive>& drives,
                                                        const BundleStage& stage,
                                                        const BundleResult& result);

}  // namespace roadbook
