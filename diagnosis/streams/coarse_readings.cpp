#include "diagnosis/streams/coarse_readings.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>

namespace roadbook {
namespace {

constexpr std::size_t kFewestSquares = 50;
constexpr double kFinest = 3e-6;  // [rad, rad/s]: rounding of text files

// Step of the grid of values: the lower quartile of the gaps between distinct values, because some
// grid values do not occur. 0 if hardly any value repeats, or if the gaps vary as in an exact
// simulation with few turns.
double grid_step(std::vector<double> readings) {
  constexpr std::size_t kFewestValues = 8;
  constexpr double kAlike = 0.1;
  const std::size_t count = readings.size();
  std::sort(readings.begin(), readings.end());
  readings.erase(std::unique(readings.begin(), readings.end()), readings.end());
  if (readings.size() < kFewestValues || 2 * readings.size() > count) return 0.0;
  std::vector<double> gaps;
  for (std::size_t i = 1; i < readings.size(); ++i) gaps.push_back(readings[i] - readings[i - 1]);
  const auto quarter = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 4);
  std::nth_element(gaps.begin(), quarter, gaps.end());
  const double step = *quarter;
  const auto alike = static_cast<std::size_t>(std::count_if(
      gaps.begin(), gaps.end(), [&](double g) { return std::abs(g - step) < kAlike * step; }));
  return 2 * alike >= gaps.size() ? step : 0.0;
}

// Mean square about the lines of the windows, without the quarter of windows with the largest
// values (outliers and bends).
double usual_square(const std::vector<WindowObservation>& windows) {
  std::vector<double> squares;
  for (const WindowObservation& w : windows)
    if (w.count > 2) squares.push_back(w.squares / (static_cast<double>(w.count) - 2.0));
  if (squares.size() < kFewestSquares) return std::numeric_limits<double>::infinity();
  const std::size_t usual = squares.size() - squares.size() / 4;
  std::nth_element(squares.begin(), squares.begin() + static_cast<std::ptrdiff_t>(usual) - 1,
                   squares.end());
  double sum = 0.0;
  for (std::size_t i = 0; i < usual; ++i) sum += squares[i];
  return sum / static_cast<double>(usual);
}

std::string coarse(const char* stream, double step, const char* unit) {
  char text[300];
  std::snprintf(text, sizeof text,
                "data fault: %s has steps of %.3g %s, coarser than its noise: equal angles or "
                "rates are rounded equally, and the other noise effects of %s are not observable",
                stream, step, unit, stream);
  return text;
}

}  // namespace

double coarse_step(std::vector<double> readings, const std::vector<WindowObservation>& windows) {
  const double step = grid_step(std::move(readings));
  // Rounding has a variance of step^2 / 12. Noise of half a step hides the grid (Widrow 1956): both
  // together have a third of step^2.
  return step > kFinest && usual_square(windows) < step * step / 3.0 ? step : 0.0;
}

double rounding_sigma(double step) { return step / std::sqrt(12.0); }

std::vector<std::size_t> windows_alike(const std::vector<WindowObservation>& windows, double step) {
  const double same = 1e-6 * step;  // tolerance for sums
  const auto stands = [&](const WindowObservation& w) {
    return w.count > 2 && w.squares < same * same;
  };
  const auto level = [&](const WindowObservation& w) { return std::llround(w.value / step); };
  std::map<long long, std::size_t> standing;
  for (const WindowObservation& w : windows)
    if (stands(w)) ++standing[level(w)];
  std::vector<std::size_t> alike;
  for (const WindowObservation& w : windows) alike.push_back(stands(w) ? standing[level(w)] : 1);
  return alike;
}

const std::vector<WindowObservation>& windows_of_noise(const Observations& obs, Channel channel) {
  static const std::vector<WindowObservation> kNone;
  if (channel == Channel::kGyro) return obs.gyro_step_rad_s > 0.0 ? kNone : obs.gyro;
  return obs.steering_step_rad > 0.0 ? kNone : obs.steering;
}

std::vector<std::string> coarse_readings(const Observations& obs) {
  std::vector<std::string> lines;
  if (obs.steering_step_rad > 0.0)
    lines.push_back(coarse("steering0", obs.steering_step_rad, "rad"));
  if (obs.gyro_step_rad_s > 0.0) lines.push_back(coarse("imu0", obs.gyro_step_rad_s, "rad/s"));
  return lines;
}

}  // namespace roadbook
