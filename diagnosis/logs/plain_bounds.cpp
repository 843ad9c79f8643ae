#include "diagnosis/logs/plain_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "drive/plausible.hpp"
#include "drive/table_faults.hpp"

namespace roadbook {
namespace {

constexpr double kRightAngle_rad = 1.6;  // steered wheels of tricycles and forklifts reach it

void note_large_value(const std::string& field,
                      double value,
                      double most,
                      const std::string& unit,
                      const std::string& cause,
                      std::vector<std::string>& notes) {
  if (!(std::abs(value) > most)) return;
  std::ostringstream text;
  text.precision(4);
  text << field << ": up to " << std::abs(value) << " " << unit << in_brackets(cause)
       << ", where vehicles have at most " << most;
  notes.push_back(text.str());
}

}  // namespace

std::vector<std::string> implausible_values(const MotionStreams& streams) {
  std::vector<std::string> notes;
  double steering = 0.0;
  for (const auto& s : streams.steering) steering = std::max(steering, std::abs(s.angle_rad));
  note_large_value("steering.angle", steering, kRightAngle_rad, "rad",
                   degrees_cause(steering, kRightAngle_rad), notes);
  double rate = 0.0;
  for (const auto& g : streams.gyro) rate = std::max(rate, std::abs(g.rate_rad_s));
  note_large_value("gyro.rate", rate, kMostTurnRate_rad_s, "rad/s",
                   degrees_cause(rate, kMostTurnRate_rad_s), notes);
  const WheelModel& m = streams.wheel_model;
  const auto size = [&](const std::string& key, double value, double most) {
    note_large_value("vehicle." + key, value, most, "m", "millimetres?", notes);
  };
  size("radius_m", std::max(m.radius_left_m, m.radius_right_m), 2.0);
  size("track_width_m", m.track_width_m, 10.0);
  size("wheelbase_m", m.wheelbase_m, 30.0);
  return notes;
}

}  // namespace roadbook
