#pragma once

namespace roadbook {

/// Limits for opening a drive.
struct DriveOptions {
  double max_image_megapixels = 64.0;  ///< larger images are refused before they are decoded
  /// Largest difference between the stamps of one instant's images [s].
  double stamp_tolerance_s = 0.005;
  int num_threads = 0;  ///< for looking at the image files; 0: all cores
};

}  // namespace roadbook
