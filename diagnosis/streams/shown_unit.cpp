#include "diagnosis/streams/shown_unit.hpp"

#include <algorithm>
#include <numbers>
#include <utility>
#include <vector>

#include "base/median.hpp"

namespace roadbook {

ShownUnit shown_unit(const Observations& obs, Channel channel) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  std::vector<double> intervals;  // the usual one: gaps do not count
  for (std::size_t i = 1; i < obs.wheels.size(); ++i)
    intervals.push_back(obs.wheels[i].t_s - obs.wheels[i - 1].t_s);
  const double interval_s = intervals.empty() ? 1.0 : std::max(median(std::move(intervals)), 1e-9);
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
