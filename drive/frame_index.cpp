#include "drive/frame_index.hpp"

#include <algorithm>
#include <string>

namespace roadbook {

FrameIndex index_frames(const std::vector<ImageStream>& images) {
  FrameIndex frames;
  for (const ImageStream& stream : images)
    frames.stamps_ns.insert(frames.stamps_ns.end(), stream.stamps_ns.begin(),
                            stream.stamps_ns.end());
  std::sort(frames.stamps_ns.begin(), frames.stamps_ns.end());
  frames.stamps_ns.erase(std::unique(frames.stamps_ns.begin(), frames.stamps_ns.end()),
                         frames.stamps_ns.end());
  frames.stamps_ns.shrink_to_fit();
  frames.cameras.assign(frames.stamps_ns.size(), 0);
  const std::size_t count = std::min(images.size(), FrameIndex::kMaxCameras);
  for (std::size_t camera = 0; camera < count; ++camera) {
    std::size_t frame = 0;
    for (const std::int64_t t : images[camera].stamps_ns) {
      while (frames.stamps_ns[frame] != t) ++frame;
      frames.cameras[frame] |= std::uint64_t{1} << camera;
    }
  }
  return frames;
}

void warn_of_ended_cameras(const std::vector<ImageStream>& images,
                           const FrameIndex& frames,
                           ProblemList& problems) {
  constexpr double kIntervals = 10.0;
  if (frames.stamps_ns.empty()) return;
  const std::int64_t end = frames.stamps_ns.back();
  for (const ImageStream& stream : images) {
    if (stream.stamps_ns.empty() || !(stream.summary.rate_hz > 0.0)) continue;
    const std::int64_t last = stream.stamps_ns.back();
    if (static_cast<double>(end - last) > kIntervals * 1e9 / stream.summary.rate_hz)
      problems.warning((stream.folder.parent_path() / "data.csv").string(), 0, "images",
                       "the last at " + std::to_string(last) + " ns",
                       "images until " + std::to_string(end) + " ns as other cameras have");
  }
}

}  // namespace roadbook
