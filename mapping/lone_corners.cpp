#include "mapping/lone_corners.hpp"

#include "base/index.hpp"
#include "vo/track_options.hpp"

namespace roadbook {

std::vector<LoneCorner> lone_corners(const MappingInput& input,
                                     const std::vector<JoinedTrack>& tracks,
                                     int min_views,
                                     std::size_t first_keyframe) {
  const auto& keyframes = input.odometry.keyframes;
  std::vector<std::vector<std::vector<bool>>> explained(keyframes.size());  // keyframe, camera
  for (std::size_t k = first_keyframe; k < keyframes.size(); ++k)
    for (const Features& features : keyframes[k].features)
      explained[k].emplace_back(features.size(), false);
  for (const JoinedTrack& track : tracks) {
    if (!track.p_map || static_cast<int>(track.views.size()) < min_views) continue;
    for (const KeyPointId& view : track.views)
      if (at(view.keyframe) >= first_keyframe)
        explained[at(view.keyframe)][at(view.camera)][at(view.feature)] = true;
  }
  std::vector<LoneCorner> corners;
  for (std::size_t k = first_keyframe; k < keyframes.size(); ++k)
    for (std::size_t c = 0; c < keyframes[k].features.size(); ++c) {
      const Features& features = keyframes[k].features[c];
      std::size_t kept = 0;
      for (std::size_t f = 0; f < features.size() && kept < kLoneCornersPerImage; ++f) {
        if (explained[k][c][f]) continue;
        ++kept;
        const Eigen::Vector2d pixel = full_size_pixel(features.pixels[f].cast<double>());
        corners.push_back({static_cast<int>(k), static_cast<int>(c), pixel.cast<float>(),
                           features.descriptors[f]});
      }
    }
  return corners;
}

}  // namespace roadbook
