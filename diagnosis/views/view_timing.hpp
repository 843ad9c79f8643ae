#pragma once

#include <vector>

#include "diagnosis/views/view_data.hpp"
#include "sensors/effects.hpp"

namespace roadbook {

// What effects say of when the rows of images were read out, and how the car moved then: as the
// wheels read, less what their own effects make them read.
class ViewTiming {
 public:
  ViewTiming(const ViewData& data, const EffectSizes& effects);

  /// Of a row against the stamp [s].
  [[nodiscard]] double after_stamp(const Camera& camera, int which, double row) const;
  /// Mean twist of the car from the stamp of a pose until `dt_s` later.
  [[nodiscard]] Vector6d twist(int pose, double dt_s) const;
  /// Share of the rolling shutter's time at a row: 0 in the middle.
  [[nodiscard]] static double row_share(const Camera& camera, double row);

 private:
  std::vector<double> shutter_, late_;  ///< of each camera
  double wheels_late_ = 0.0;
  std::vector<ViewMoment> moments_;  ///< with rates that are, not those read
};

}  // namespace roadbook
