#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/progress.hpp"
#include "drive/writer.hpp"

namespace roadbook {

/// Decodes a video in order into camera 0, frame i with stamp i, until one of them ends; returns
/// the number of images. Throws BadInput where the video cannot be opened, has another size than
/// the camera or fewer frames than stamps.
std::size_t import_video_frames(const std::filesystem::path& file,
                                const std::vector<std::int64_t>& stamps_ns,
                                DriveWriter& writer,
                                const Progress& progress);

/// The camera of a comma EON (1164x874, 910 px), 1.22 m over the ground: what comma2k19 states.
[[nodiscard]] MountedCamera comma_camera();

}  // namespace roadbook
