#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "vo/descriptor.hpp"

namespace roadbook {

// BRISK features of one half-size image [metric-semantic maps, section III], spread evenly over it.

struct FeatureOptions {
  int max_features = 320;  ///< per image
  int cell_px = 32;        ///< side of the cells that spread the features over the image
  int max_per_cell = 3;    ///< only this number of the strongest features stays in each cell
  /// Least number per image, if it has so many corners: cells keep more than max_per_cell for it.
  int fewest = 0;
  int threshold = 22;       ///< AGAST corner threshold [grey levels]
  int low_threshold = 9;    ///< tried where the first one finds too few (dim or plain images)
  double border_px = 12.0;  ///< distance kept from the image border

  /// Throws InvalidOption.
  void check() const;
};

/// Features of one image, strongest first; pixels of the half-size image.
struct Features {
  std::vector<Eigen::Vector2f> pixels;
  std::vector<Descriptor> descriptors;
  [[nodiscard]] std::size_t size() const { return pixels.size(); }
};

/// Detects features in an 8-bit grey image of half size and describes them. `mask` (same size, 8
/// bit; empty: none) is 0 where no feature may lie, such as the own car. Throws InvalidOption.
/// Deterministic; safe to call concurrently.
[[nodiscard]] Features detect_features(const cv::Mat& half_image,
                                       const cv::Mat& mask,
                                       const FeatureOptions& options = {});

}  // namespace roadbook
