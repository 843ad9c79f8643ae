#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "drive/images/image_stream.hpp"
#include "drive/problem_list.hpp"

namespace roadbook {

/// The way of the wheels between two stamps [m]; negative: not known.
using WayOfWheels = std::function<double(std::int64_t first_ns, std::int64_t last_ns)>;

/// Warns of cameras that repeat the bytes of one image while the wheels roll or, where no wheels
/// are known, while another camera's images still change. A single camera without wheels is
/// warned of as well: the images of a real camera differ by its noise even at rest.
void warn_of_frozen_images(const std::vector<ImageStream>& images,
                           const WayOfWheels& way,
                           ProblemList& problems);

}  // namespace roadbook
