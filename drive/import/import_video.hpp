#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "base/progress.hpp"
#include "drive/writer.hpp"

namespace roadbook {

/// Stamp of each frame of a video, in order; empty: a frame whose stamp is not known.
using FrameStamps = std::vector<std::optional<std::int64_t>>;

/// Decodes a video in order into camera 0, frame i with stamp i; frames without a stamp are left
/// out. Returns the number of images. Throws BadInput where the video cannot be opened, has another
/// size than the camera, or has more or fewer frames than there are stamps.
std::size_t import_video_frames(const std::filesystem::path& file,
                                const FrameStamps& stamps_ns,
                                DriveWriter& writer,
                                const Progress& progress);

/// The camera of a comma EON (1164x874, 910 px), 1.22 m over the ground: what comma2k19 states.
[[nodiscard]] MountedCamera comma_camera();

}  // namespace roadbook
