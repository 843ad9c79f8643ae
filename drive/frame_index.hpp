#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "drive/images/image_stream.hpp"
#include "drive/problem_list.hpp"

namespace roadbook {

/// Instants with images: a stamp and one bit a camera.
struct FrameIndex {
  static constexpr std::size_t kMaxCameras = 64;
  std::vector<std::int64_t> stamps_ns;
  std::vector<std::uint64_t> cameras;
};

/// Returns the instants at which at least one camera has an image. The streams stand by camera;
/// those beyond `FrameIndex::kMaxCameras` have no bit.
[[nodiscard]] FrameIndex index_frames(const std::vector<ImageStream>& images);

/// Warns of cameras whose images end long before those of the others, because the camera has died.
/// The drive stays usable.
void warn_of_ended_cameras(const std::vector<ImageStream>& images,
                           const FrameIndex& frames,
                           ProblemList& problems);

}  // namespace roadbook
