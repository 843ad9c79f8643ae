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
  std::vector<std::int64_t> stamps_ns;  ///< of the image of the instant's first camera
  std::vector<std::uint64_t> cameras;
  /// By camera: the image's own stamp less the instant's [ns]; empty where all are zero.
  std::vector<std::vector<std::int32_t>> offsets_ns;

  [[nodiscard]] std::int64_t image_stamp_ns(std::size_t frame, std::size_t camera) const {
    const bool same = camera >= offsets_ns.size() || offsets_ns[camera].empty();
    return stamps_ns.at(frame) + (same ? 0 : offsets_ns[camera].at(frame));
  }
};

/// Returns the instants at which at least one camera has an image, ascending. Images of other
/// cameras whose stamps differ by at most `tolerance_s`, and by at most half of the shortest
/// interval between the images of a camera, belong to one instant. Equal stamps are never parted.
/// The streams stand by camera; those beyond `FrameIndex::kMaxCameras` are left out.
[[nodiscard]] FrameIndex index_frames(const std::vector<ImageStream>& images, double tolerance_s);

/// Where cameras with different time offsets (`shifted_ns`) were triggered together, the offsets
/// part the images of an instant. If equal offsets make fewer instants by a tenth, gives all
/// streams the offset of the first camera, and returns by camera how much later [ns] than the stamp
/// its images were taken; otherwise changes nothing and returns zeros.
[[nodiscard]] std::vector<std::int64_t> join_triggered_images(std::vector<ImageStream>& images,
                                                              double tolerance_s);

/// Warns of cameras whose images lie apart from those of the first camera by more than the
/// tolerance: then no instant has images of both.
void warn_of_unpaired_cameras(const std::vector<ImageStream>& images,
                              double tolerance_s,
                              ProblemList& problems);

/// Warns of cameras whose images end long before those of the others, because the camera has died.
/// The drive stays usable.
void warn_of_ended_cameras(const std::vector<ImageStream>& images,
                           const FrameIndex& frames,
                           ProblemList& problems);

}  // namespace roadbook
