#pragma once

#include <cstddef>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "sensors/rig.hpp"

namespace roadbook {

/// Fewest images of a moving vehicle from which its own parts can be found.
inline constexpr std::size_t kFewestMovingImages = 8;

/// Images spread over a drive of `count` images for `find_still_parts`; `read(i)` gives image i
/// (8-bit grey; an empty one is left out).
///
/// First takes 32 images at equal steps. If the vehicle moves in fewer than `kFewestMovingImages`
/// of them (long stops), takes 512 at equal steps and returns up to 32 of those in which it moves.
/// Empty for fewer than two images.
[[nodiscard]] std::vector<cv::Mat> spread_images(std::size_t count,
                                                 const std::function<cv::Mat(std::size_t)>& read);

/// Finds the own vehicle in images as the parts that never move while the scene moves: 255 where it
/// is seen, 0 elsewhere; empty if it is not seen or not decidable.
/// `images`: 8-bit grey, in driving order, spread over the drive, of `mounted`'s size. Images at
/// standstill (hardly different from the one before) do not count. Fewer than `kFewestMovingImages`
/// others are not enough, nor is a drive at standstill.
/// The measure is the coherence of the brightness gradient g over the images, |mean g| / mean |g|:
/// 1 on a still edge, about 1 / sqrt(images) on a moving scene and on noise. Changes of brightness
/// scale g and do not turn it. Coherent edges that reach the border of the view belong to the
/// vehicle; above the horizon only strong ones, because clouds ahead of a straight road are still
/// too; at the horizon none. A region without texture belongs to the vehicle only if it lies below
/// the horizon, its brightness stays, and coherent edges surround most of it, which excludes sky
/// and bare road.
/// Deterministic. About 2 ms an image of 640x480.
[[nodiscard]] cv::Mat find_still_parts(const std::vector<cv::Mat>& images,
                                       const MountedCamera& mounted);

}  // namespace roadbook
