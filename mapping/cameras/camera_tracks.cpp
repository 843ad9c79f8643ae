#include "mapping/cameras/camera_tracks.hpp"

#include <algorithm>

namespace roadbook {
namespace {

const Features& features_at(const MappingInput& input, int keyframe, int camera) {
  return input.odometry.keyframes[static_cast<std::size_t>(keyframe)]
      .features[static_cast<std::size_t>(camera)];
}

bool follows(const MappingInput& input, int keyframe, int session) {
  return keyframe > 0 && input.session[static_cast<std::size_t>(keyframe)] == session &&
         input.session[static_cast<std::size_t>(keyframe) - 1] == session &&
         !input.odometry.keyframes[static_cast<std::size_t>(keyframe)].after_gap;
}

// The feature of `next` that each of `features` finds and that finds it in turn; -1: none.
std::vector<int> mutual_matches(const Features& features,
                                const Features& next,
                                const CameraTrackOptions& options) {
  std::vector<int> found(features.size(), -1);
  for (std::size_t i = 0; i < features.size(); ++i) {
    const auto there = nearest_descriptor(features.descriptors[i], next.descriptors);
    if (there.index < 0 || there.distance > options.max_hamming ||
        there.distance > options.max_ratio * there.second)
      continue;
    const auto back = nearest_descriptor(next.descriptors[static_cast<std::size_t>(there.index)],
                                         features.descriptors);
    if (back.index == static_cast<int>(i)) found[i] = there.index;
  }
  return found;
}

std::vector<CameraTrack> follow_stretch(const MappingInput& input,
                                        int first,
                                        int count,
                                        int camera,
                                        const CameraTrackOptions& options) {
  std::vector<CameraTrack> tracks;
  std::vector<int> track_of(features_at(input, first, camera).size(), -1);
  for (int k = first; k + 1 < first + count; ++k) {
    const Features& here = features_at(input, k, camera);
    const Features& next = features_at(input, k + 1, camera);
    const auto found = mutual_matches(here, next, options);
    std::vector<int> track_of_next(next.size(), -1);
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (found[i] < 0) continue;
      int& track = track_of[i];
      if (track < 0) {
        track = static_cast<int>(tracks.size());
        tracks.push_back({0, {{k, here.pixels[i].cast<double>()}}});
      }
      const auto j = static_cast<std::size_t>(found[i]);
      tracks[static_cast<std::size_t>(track)].views.push_back(
          {k + 1, next.pixels[j].cast<double>()});
      track_of_next[j] = track;
    }
    track_of = std::move(track_of_next);
  }
  std::erase_if(tracks, [](const CameraTrack& track) { return track.views.size() < 3; });
  return tracks;
}

}  // namespace

std::vector<CameraTrack> follow_corners(const MappingInput& input,
                                        int session,
                                        int camera,
                                        const CameraTrackOptions& options) {
  std::vector<int> starts;
  int run = 0;  // keyframes up to here without a gap
  for (int k = 0; k < static_cast<int>(input.session.size()); ++k) {
    run = follows(input, k, session) ? run + 1 : 1;
    if (input.session[static_cast<std::size_t>(k)] == session && run >= options.keyframes)
      starts.push_back(k - options.keyframes + 1);
  }
  const auto wanted = static_cast<std::size_t>(options.stretches);
  const std::size_t count =
      std::min(wanted, (starts.size() + static_cast<std::size_t>(options.keyframes) - 1) /
                           static_cast<std::size_t>(options.keyframes));
  std::vector<CameraTrack> tracks;
  for (std::size_t s = 0; s < count; ++s) {
    const int first = starts[count < 2 ? 0 : s * (starts.size() - 1) / (count - 1)];
    auto found = follow_stretch(input, first, options.keyframes, camera, options);
    const std::size_t most = options.most / count + 1;
    const std::size_t taken = std::min(most, found.size());
    for (std::size_t i = 0; i < taken; ++i) {
      CameraTrack& track = found[i * found.size() / taken];
      track.stretch = static_cast<int>(s);
      tracks.push_back(std::move(track));
    }
  }
  return tracks;
}

double repeated_share(const MappingInput& input, int session, int camera) {
  constexpr std::size_t kFewest = 10;
  std::size_t compared = 0;
  std::size_t same = 0;
  for (int k = 1; k < static_cast<int>(input.session.size()); ++k) {
    if (!follows(input, k, session)) continue;
    const auto& before = features_at(input, k - 1, camera).pixels;
    const auto& now = features_at(input, k, camera).pixels;
    if (before.size() < kFewest) continue;
    ++compared;
    same += before == now ? 1 : 0;
  }
  return compared == 0 ? 0.0 : static_cast<double>(same) / static_cast<double>(compared);
}

}  // namespace roadbook
