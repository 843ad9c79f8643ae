#include "diagnosis/streams/dead_reckoning.hpp"

#include <algorithm>
#include <cmath>

namespace roadbook {
namespace {

constexpr double kReadingGap = 0.5;  // [s] gaps longer than this are not interpolated

// Mean rates of the wheels between the readings before and after t.
struct MeanRates {
  double speed = 0.0;
  double yaw_rate = 0.0;
};

std::optional<MeanRates> wheel_rates(const Observations& obs, double t) {
  const auto after =
      std::upper_bound(obs.wheels.begin(), obs.wheels.end(), t,
                       [](double value, const WheelObservation& w) { return value < w.t_s; });
  if (after == obs.wheels.begin() || after == obs.wheels.end()) return std::nullopt;
  const WheelObservation& a = *std::prev(after);
  const double dt = after->t_s - a.t_s;
  if (dt > kReadingGap) return std::nullopt;
  return MeanRates{(after->distance_m - a.distance_m) / dt, (after->heading - a.heading) / dt};
}

double middle(const WindowObservation& w) { return 0.5 * (w.begin_s + w.end_s); }

// Interpolates between the windows before and after t.
std::optional<double> window_value(const std::vector<WindowObservation>& windows, double t) {
  const auto after =
      std::upper_bound(windows.begin(), windows.end(), t,
                       [](double value, const WindowObservation& w) { return value < middle(w); });
  if (after == windows.begin() || after == windows.end()) return std::nullopt;
  const WindowObservation& a = *std::prev(after);
  const double dt = middle(*after) - middle(a);
  if (dt > kReadingGap) return std::nullopt;
  const double share = (t - middle(a)) / dt;
  return (1.0 - share) * a.value + share * after->value;
}

}  // namespace

double pose_gap_s(const std::vector<PoseSample>& poses) {
  constexpr double kShort = 1.0;  // [s]
  std::vector<double> steps;
  for (std::size_t i = 1; i < poses.size(); ++i) steps.push_back(poses[i].t_s - poses[i - 1].t_s);
  if (steps.empty()) return kShort;
  const auto usual = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), usual, steps.end());
  return std::max(kShort, 3.0 * *usual);
}

std::optional<double> reckoned_speed(const Observations& obs, double t_s) {
  const auto rates = wheel_rates(obs, t_s);
  if (!rates) return std::nullopt;
  return rates->speed;
}

std::optional<double> reckoned_yaw_rate(const Observations& obs, double t_s) {
  if (const auto rate = window_value(obs.gyro, t_s)) return rate;
  const auto rates = wheel_rates(obs, t_s);
  if (!rates) return std::nullopt;
  if (obs.wheels_read == WheelsRead::kBoth) return rates->yaw_rate;
  const auto angle = window_value(obs.steering, t_s);
  if (!angle) return std::nullopt;
  return rates->speed * std::tan(*angle) / obs.wheel_model.wheelbase_m;
}

double reckoned_turn(const Observations& obs, double from_s, double to_s) {
  const auto steps = static_cast<std::size_t>(std::ceil((to_s - from_s) / obs.step_s));
  const double step = (to_s - from_s) / static_cast<double>(std::max<std::size_t>(steps, 1));
  double turned = 0.0;
  for (std::size_t k = 0; k < steps; ++k)
    turned +=
        step * reckoned_yaw_rate(obs, from_s + (static_cast<double>(k) + 0.5) * step).value_or(0.0);
  return turned;
}

}  // namespace roadbook
