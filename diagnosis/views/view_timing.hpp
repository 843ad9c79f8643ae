#pragma once

#include <vector>

#include "diagnosis/views/view_data.hpp"
#include "sensors/effects.hpp"

namespace roadbook {

// Time at which an image row is exposed, and the motion of the car then, given latency and rolling
// shutter effects. Wheel effects are removed from the motion that the wheels read.
class ViewTiming {
 public:
  ViewTiming(const ViewData& data, const EffectSizes& effects);

  /// Exposure time of `row` of camera `which` minus the stamp of the image [s].
  [[nodiscard]] double after_stamp(const Camera& camera, int which, double row) const;
  /// Mean twist of the car (vehicle frame) over `dt_s` seconds from the stamp of a pose.
  [[nodiscard]] Vector6d twist(int pose, double dt_s) const;
  /// Position of a row in the rolling shutter's readout time, 0 in the middle of the image.
  [[nodiscard]] static double row_share(const Camera& camera, double row);

 private:
  std::vector<double> shutter_, late_;  ///< one a camera
  double wheels_late_ = 0.0;
  std::vector<ViewMoment> moments_;  ///< with rates corrected for wheel effects
};

}  // namespace roadbook
