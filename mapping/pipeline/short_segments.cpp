#include "mapping/pipeline/short_segments.hpp"

#include <cstddef>
#include <utility>

namespace roadbook {
namespace {

// The index of each keyframe among those that stay; -1: removed.
std::vector<int> new_indices(const std::vector<VoKeyframe>& keyframes, int fewest) {
  std::vector<int> index(keyframes.size(), -1);
  int next = 0;
  for (std::size_t begin = 0, end = 0; begin < keyframes.size(); begin = end) {
    end = begin + 1;
    while (end < keyframes.size() && !keyframes[end].after_gap) ++end;
    if (static_cast<int>(end - begin) < fewest) continue;
    for (std::size_t k = begin; k < end; ++k) index[k] = next++;
  }
  return index;
}

// The index of each track among those that still have two key points; -1: removed.
std::vector<int> shorten_tracks(const std::vector<int>& keyframe_index,
                                std::vector<Track>& tracks) {
  std::vector<int> index(tracks.size(), -1);
  std::size_t next = 0;
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    auto& seen = tracks[t].observations;
    for (TrackObservation& o : seen)
      o.keyframe = keyframe_index[static_cast<std::size_t>(o.keyframe)];
    std::erase_if(seen, [](const TrackObservation& o) { return o.keyframe < 0; });
    if (seen.size() < 2) continue;
    index[t] = static_cast<int>(next);
    if (next != t) tracks[next] = std::move(tracks[t]);
    ++next;
  }
  tracks.resize(next);
  return index;
}

}  // namespace

int remove_short_segments(VoResult& odometry, int fewest) {
  const auto keyframe_index = new_indices(odometry.keyframes, fewest);
  std::size_t kept = 0;
  for (std::size_t k = 0; k < keyframe_index.size(); ++k) {
    if (keyframe_index[k] < 0) continue;
    if (kept != k) odometry.keyframes[kept] = std::move(odometry.keyframes[k]);
    ++kept;
  }
  const int removed = static_cast<int>(keyframe_index.size() - kept);
  if (removed == 0) return 0;
  odometry.keyframes.resize(kept);
  if (kept > 0) odometry.keyframes.front().after_gap = false;
  const auto track_index = shorten_tracks(keyframe_index, odometry.tracks);
  for (VoKeyframe& keyframe : odometry.keyframes)
    for (auto& tracks : keyframe.tracks)
      for (int& id : tracks)
        if (id >= 0) id = track_index[static_cast<std::size_t>(id)];
  return removed;
}

}  // namespace roadbook
