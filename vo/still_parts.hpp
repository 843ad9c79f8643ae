#pragma once

#include <cstddef>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "sensors/rig.hpp"

namespace roadbook {

/// Fewest images of a moving vehicle from which its own parts can be found.
inline constexpr std::size_t kFewestMovingImages = 8;

/// Chooses images for `find_still_parts` that are spread over a drive of `count` images. `read(i)`
/// returns image i as 8-bit grey; empty images are left out.
///
/// First takes 32 images at equal steps. If the vehicle moves in fewer than `kFewestMovingImages`
/// of them (long stops), takes 512 at equal steps and returns up to 32 in which it moves.
/// Empty for fewer than two images.
[[nodiscard]] std::vector<cv::Mat> spread_images(std::size_t count,
                                                 const std::function<cv::Mat(std::size_t)>& read);

/// Finds the own vehicle in images as the parts that never move while the scene moves. Returns an
/// 8-bit mask: 255 where the vehicle is seen, 0 elsewhere; empty if it is not seen or not
/// decidable.
///
/// `images`: 8-bit grey, in driving order, spread over the drive, of `mounted`'s size. Images at
/// standstill (hardly different from the image before) do not count; at least `kFewestMovingImages`
/// others are needed.
///
/// The measure is the coherence of the brightness gradient g over the images, |mean g| / mean |g|:
/// 1 on a still edge, about 1 / sqrt(images) on a moving scene and on noise. Changes of brightness
/// scale g and do not turn it. Coherent edges that reach the border of the view belong to the
/// vehicle. Above the horizon only strong edges count, because clouds ahead of a straight road are
/// still too; at the horizon no edge counts. A region without texture belongs to the vehicle if it
/// lies below the horizon, its brightness stays, and coherent edges surround most of it. This
/// excludes sky and bare road.
///
/// Deterministic. Takes about 2 ms for an image of 640x480.
[[nodiscard]] cv::Mat find_still_parts(const std::vector<cv::Mat>& images,
                                       const MountedCamera& mounted);

}  // namespace roadbook
