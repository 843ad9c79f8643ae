#pragma once

#include <string>
#include <vector>

#include "diagnosis/brightness/brightness_samples.hpp"

namespace roadbook {

enum class BrightnessKind { kVignetting, kExposure, kStep };

/// A brightness effect of one camera or of all.
struct BrightnessCause {
  std::string name;
  std::string unit;
  BrightnessKind kind = BrightnessKind::kVignetting;
  int camera = -1;  ///< -1: all
  double tau = 0.0;
  double from_s = 0.0;  ///< for kStep: time from which it acts
};

/// All candidates: effects of each camera and of all cameras; exposure steps at up to 60 times
/// between the images, one candidate each.
[[nodiscard]] std::vector<BrightnessCause> brightness_causes(
    const std::vector<std::string>& cameras, const std::vector<BrightnessSample>& samples);

}  // namespace roadbook
