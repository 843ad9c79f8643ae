#pragma once

namespace roadbook {

/// Two key points that show the same corner.
struct FeatureMatch {
  int from_camera = 0;
  int from_feature = 0;
  int to_camera = 0;
  int to_feature = 0;
};

}  // namespace roadbook
