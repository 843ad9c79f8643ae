#pragma once

#include <string>
#include <vector>

#include "diagnosis/brightness/brightness_samples.hpp"

namespace roadbook {

enum class BrightnessKind { kVignetting, kExposure, kStep };

/// What may be wrong with how bright a camera shows things.
struct BrightnessCause {
  std::string name;
  std::string unit;
  BrightnessKind kind = BrightnessKind::kVignetting;
  int camera = -1;  ///< -1: all
  double tau = 0.0;
  double from_s = 0.0;  ///< of a step: acts from here on
};

/// Of each camera and of all; steps at up to 60 moments between the images, one cause each.
[[nodiscard]] std::vector<BrightnessCause> brightness_causes(
    const std::vector<std::string>& cameras, const std::vector<BrightnessSample>& samples);

}  // namespace roadbook
