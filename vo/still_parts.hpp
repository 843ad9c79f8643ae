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

/// Finds the own vehicle in images as what never moves while the scene does: 255 where it is seen,
/// 0 elsewhere; empty where it is not seen, or where nothing can be said.
///
/// `images`: 8-bit grey, in driving order, spread over the drive, of `mounted`'s size. An image
/// that hardly differs from the one before (the vehicle stands) does not count; fewer than
/// `kFewestMovingImages` others tell nothing, nor does a drive in which most of the scene stands.
///
/// The measure is the coherence of the brightness gradient g over the images, |mean g| / mean |g|:
/// 1 on an edge that stands in the image, about 1 / sqrt(images) on a scene that moves and on
/// noise. Brightness may change: it scales g and turns it nowhere. Coherent edges that reach the
/// border of the view are taken as the vehicle's; where they lie above the horizon, only strong
/// ones, as clouds ahead of a straight road stand too; at the horizon itself none. A region without
/// texture belongs to the vehicle only if it lies below the horizon, its brightness stays and
/// coherent edges run along most of its outline: sky and bare road do not.
///
/// Deterministic. About 2 ms an image of 640x480.
[[nodiscard]] cv::Mat find_still_parts(const std::vector<cv::Mat>& images,
                                       const MountedCamera& mounted);

}  // namespace roadbook
