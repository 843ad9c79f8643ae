#include "diagnosis/streams/shown_unit.hpp"

#include <numbers>

namespace roadbook {

ShownUnit shown_unit(const Observations& obs, Channel channel) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  const double interval_s = obs.wheels.size() > 1
                                ? (obs.wheels.back().t_s - obs.wheels.front().t_s) /
                                      static_cast<double>(obs.wheels.size() - 1)
                                : 1.0;
  switch (channel) {
    case Channel::kWheelDistance:
      return {"cm/s", 100.0 / interval_s};
    case Channel::kWheelHeading:
      return {"deg/s", kDegrees / interval_s};
    case Channel::kGyro:
      return {"deg/s", kDegrees};
    case Channel::kSteering:
    case Channel::kPoseHeading:
      return {"deg", kDegrees};
    default:
      return {"cm", 100.0};
  }
}

}  // namespace roadbook
