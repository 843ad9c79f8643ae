#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "semantics/oriented_box.hpp"
#include "semantics/overhead/ground_image.hpp"

namespace roadbook {

/// A simulated overhead image of a car park, without a drive through it. It has painted ground with
/// wear, stains and light, cars on some spaces, and the blur and noise of a mosaic. Another `floor`
/// has other cars, stains and wear.
struct PaintedLot {
  GroundImage image;
  std::vector<OrientedBox> spaces;
};

[[nodiscard]] PaintedLot painted_lot(const std::string& scenario,
                                     const std::string& size,
                                     std::uint64_t floor,
                                     int num_threads);

}  // namespace roadbook
