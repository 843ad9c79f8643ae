#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sensors/wheels.hpp"
#include "vo/keyframe_track.hpp"
#include "vo/wheels/wheel_doubts.hpp"

namespace roadbook {

// Mistakes in the wiring and the calibration of wheels that leave their readings useful: exchanged
// wheels, counters that run backwards, the diameter in place of the radius, a wrong track width.

/// What has to be done to the readings and the model. The signs belong to the wheels as they are
/// after the exchange.
struct WheelCorrection {
  bool exchange = false;  ///< left and right
  double left_sign = 1.0;
  double right_sign = 1.0;
  double radius_factor = 1.0;  ///< 1/2, 1 or 2
  double track_factor = 1.0;

  [[nodiscard]] bool is_needed() const;
  /// "left and right exchanged and a track width 0.50 times the true one": the mistakes.
  [[nodiscard]] std::string text() const;
};

[[nodiscard]] WheelModel corrected(WheelModel model, const WheelCorrection& correction);
[[nodiscard]] std::vector<WheelReading> corrected(std::vector<WheelReading> readings,
                                                  const WheelCorrection& correction);

/// The correction with which the wheels agree best with `sight`, an odometry of the cameras alone.
/// Of two that agree equally, the one with fewer mistakes. Empty if the cameras doubt more than a
/// third of the way or of the turn with each. The cameras know lengths by `ground` (their
/// ground_factor) alone, to some percent; that distinguishes a diameter from a radius. Without
/// turns, a track width and exchanged wheels cannot show.
[[nodiscard]] std::optional<WheelCorrection> find_wheel_correction(
    const VoResult& sight,
    const WheelModel& model,
    const std::vector<WheelReading>& readings,
    std::optional<double> ground);

}  // namespace roadbook
