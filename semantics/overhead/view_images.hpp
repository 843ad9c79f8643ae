#pragma once

#include <atomic>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "semantics/overhead/overhead_input.hpp"

namespace roadbook {

/// Images of the views, each for two passes. Decoding takes as long as all other work on an image,
/// so an image stays in memory from the first pass to the second while there is room.
class ViewImages {
 public:
  /// Refers to `input`. The images that are kept take at most `most_bytes` together.
  ViewImages(const OverheadInput& input, std::size_t most_bytes);

  /// The image of a view as CV_8U of the camera's size, empty where it is missing. For the first
  /// pass: keeps it if there is room. Throws BadInput. Different images may be read at the same
  /// time, here and in `last`.
  [[nodiscard]] cv::Mat first(std::size_t view, std::size_t camera);
  /// The same for the second pass: the image is not kept any longer.
  [[nodiscard]] cv::Mat last(std::size_t view, std::size_t camera);

 private:
  [[nodiscard]] cv::Mat read(std::size_t view, std::size_t camera) const;

  const OverheadInput& input_;
  std::atomic<std::int64_t> room_;          ///< [bytes]
  std::vector<std::vector<cv::Mat>> kept_;  ///< by view and camera
};

}  // namespace roadbook
