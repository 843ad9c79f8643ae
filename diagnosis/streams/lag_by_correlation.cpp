#include "diagnosis/streams/lag_by_correlation.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "diagnosis/streams/motion_prediction.hpp"

namespace roadbook {
namespace {

// Linear steps converge from smaller lags: the motion of a car changes over about a second.
constexpr double kLagInReach = 0.25;  // [s]
// Streams whose lags differ by less count as late by the same effect.
constexpr double kLagsAlike = 0.1;  // [s]

// Readings of one quantity with the true time of each at lag 0.
struct LaggedReadings {
  std::vector<double> t_s;
  std::vector<double> value;
  std::function<std::optional<double>(const MotionState&)> expected;
};

// Residual variance of a regression line of the readings on the motion, as a share of their
// variance. No value if less than half of the readings overlap with the motion or either is
// constant.
std::optional<double> unexplained_share(const LaggedReadings& readings,
                                        const Trajectory& motion,
                                        double lag_s) {
  const double begin = motion.knot_s(0);
  const double end = motion.knot_s(motion.knots() - 1);
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
  for (std::size_t k = 0; k < readings.t_s.size(); ++k) {
    const double t = readings.t_s[k] - lag_s;
    if (t < begin || t > end) continue;
    const std::optional<double> m = readings.expected(motion.rates_at(t));
    if (!m) continue;
    n += 1.0;
    x += *m;
    y += readings.value[k];
    xx += *m * *m;
    xy += *m * readings.value[k];
    yy += readings.value[k] * readings.value[k];
  }
  if (n < 0.5 * static_cast<double>(readings.t_s.size()) || n < 3.0) return std::nullopt;
  const double of_motion = xx - x * x / n;
  const double of_readings = yy - y * y / n;
  const double together = xy - x * y / n;
  if (!(of_motion > 1e-9 * xx && of_readings > 1e-9 * yy)) return std::nullopt;
  return std::clamp(1.0 - together * together / (of_motion * of_readings), 1e-9, 1.0);
}

// Mean log residual share of all quantities of one stream. This is the log likelihood of a lag with
// scale, offset and noise of each quantity fitted.
class LagSearch {
 public:
  LagSearch(const std::vector<LaggedReadings>& stream, const Trajectory& motion)
      : stream_(stream), motion_(motion) {}

  [[nodiscard]] std::optional<double> best() const {
    const double step = motion_.step_s();
    const int most = static_cast<int>(std::floor(kFarthestLag / step));
    std::vector<std::optional<double>> cost;
    for (int i = -most; i <= most; ++i) cost.push_back(cost_at(i * step));
    const std::optional<double> without = cost[static_cast<std::size_t>(most)];
    std::optional<std::size_t> least;
    for (std::size_t i = 0; i < cost.size(); ++i)
      if (cost[i] && (!least || *cost[i] < *cost[*least])) least = i;
    if (!least || !without || *least == 0 || *least + 1 == cost.size()) return std::nullopt;
    const auto& before = cost[*least - 1];
    const auto& after = cost[*least + 1];
    // At the end of the range the minimum may lie beyond.
    if (!before || !after) return std::nullopt;
    const double bend = *before - 2.0 * *cost[*least] + *after;
    const double shift = bend > 0.0 ? 0.5 * (*before - *after) / bend : 0.0;
    const double lag = (static_cast<double>(*least) - most + shift) * step;
    if (!explains(lag)) return std::nullopt;
    const double halved = static_cast<double>(stream_.size()) * std::log(2.0);
    const bool has_large_effects =
        std::abs(lag) >= kLagInReach && *cost[*least] < *without - halved;
    return has_large_effects ? lag : 0.0;
  }

  // The best lag of a coarse grid beyond the search range, if the motion explains the readings
  // there and much worse at all smaller lags.
  [[nodiscard]] std::optional<double> far() const {
    constexpr double kBetter = 3.0;
    constexpr double kWell = 0.05;  // residual share by noise alone
    const double step = 3.0 * motion_.step_s();
    const double length = motion_.knot_s(motion_.knots() - 1) - motion_.knot_s(0);
    const int nearest = static_cast<int>(std::floor(kFarthestLag / step));
    const int most = static_cast<int>(std::floor(length / step));
    const auto share = [&](double lag) {
      return unexplained_share(stream_.front(), motion_, lag).value_or(1.0);
    };
    double near = share(0.0);
    for (int i = -nearest; i <= nearest && near >= kWell; ++i)
      near = std::min(near, share(i * step));
    if (near < kWell) return std::nullopt;
    double best = std::min(kUnexplained, near / kBetter);
    std::optional<double> found;
    for (int i = nearest + 1; i <= most; ++i)
      for (const double lag : {-i * step, i * step})
        if (const double left = share(lag); left < best) {
          best = left;
          found = lag;
        }
    return found;
  }

 private:
  static constexpr double kUnexplained = 0.2;
  [[nodiscard]] std::optional<double> cost_at(double lag) const {
    double sum = 0.0;
    for (const LaggedReadings& readings : stream_) {
      const auto left = unexplained_share(readings, motion_, lag);
      if (!left) return std::nullopt;
      sum += std::log(*left);
    }
    return sum;
  }
  [[nodiscard]] bool explains(double lag) const {
    return std::all_of(stream_.begin(), stream_.end(), [&](const LaggedReadings& readings) {
      return unexplained_share(readings, motion_, lag).value_or(1.0) < kUnexplained;
    });
  }

  const std::vector<LaggedReadings>& stream_;
  const Trajectory& motion_;
};

using FindLag = std::optional<double> (LagSearch::*)() const;

double middle_of(const std::vector<double>& begin, const std::vector<double>& end, std::size_t k) {
  return 0.5 * (begin[k] + end[k]);
}

std::optional<double> lag_of_wheels(const Observations& obs,
                                    const RowTimes& times,
                                    const Trajectory& motion,
                                    FindLag find) {
  LaggedReadings speed, turn;
  speed.expected = [](const MotionState& s) { return s.speed; };
  turn.expected = [](const MotionState& s) { return s.yaw_rate; };
  for (std::size_t k = 1; k < obs.wheels.size(); ++k) {
    const double dt = obs.wheels[k].t_s - obs.wheels[k - 1].t_s;
    speed.t_s.push_back(times.wheels[k] - 0.5 * dt);
    turn.t_s.push_back(times.wheels[k] - 0.5 * dt);
    speed.value.push_back((obs.wheels[k].distance_m - obs.wheels[k - 1].distance_m) / dt);
    turn.value.push_back((obs.wheels[k].heading - obs.wheels[k - 1].heading) / dt);
  }
  std::vector<LaggedReadings> stream{speed};
  if (obs.wheels_read == WheelsRead::kBoth) stream.push_back(turn);
  return (LagSearch(stream, motion).*find)();
}

std::optional<double> lag_of_gyro(const Observations& obs,
                                  const RowTimes& times,
                                  const Trajectory& motion,
                                  FindLag find) {
  LaggedReadings rate;
  rate.expected = [](const MotionState& s) { return s.yaw_rate; };
  for (std::size_t k = 0; k < obs.gyro.size(); ++k) {
    rate.t_s.push_back(middle_of(times.gyro_begin, times.gyro_end, k));
    rate.value.push_back(obs.gyro[k].value);
  }
  const std::vector<LaggedReadings> stream{rate};
  return (LagSearch(stream, motion).*find)();
}

std::optional<double> lag_of_steering(const Observations& obs,
                                      const RowTimes& times,
                                      const Trajectory& motion,
                                      FindLag find) {
  constexpr double kLeastSpeed = 1.0;  // [m/s]; below it the curvature of the poses is noise
  LaggedReadings angle;
  angle.expected = [&](const MotionState& s) -> std::optional<double> {
    if (std::abs(s.speed) < kLeastSpeed) return std::nullopt;
    return std::atan(obs.wheel_model.wheelbase_m * s.yaw_rate / s.speed);
  };
  for (std::size_t k = 0; k < obs.steering.size(); ++k) {
    angle.t_s.push_back(middle_of(times.steering_begin, times.steering_end, k));
    angle.value.push_back(obs.steering[k].value);
  }
  const std::vector<LaggedReadings> stream{angle};
  return (LagSearch(stream, motion).*find)();
}

StreamLags lags_of(const Observations& obs,
                   const Trajectory& motion,
                   const EffectSizes& known,
                   FindLag find) {
  const RowTimes times = row_times(obs, motion_effects_of(known));
  return {lag_of_wheels(obs, times, motion, find), lag_of_steering(obs, times, motion, find),
          lag_of_gyro(obs, times, motion, find)};
}

}  // namespace

StreamLags large_lags(const Observations& obs, const Trajectory& motion, const EffectSizes& known) {
  return lags_of(obs, motion, known, &LagSearch::best);
}

StreamLags far_lags(const Observations& obs, const Trajectory& motion) {
  return lags_of(obs, motion, {}, &LagSearch::far);
}

EffectSizes named_lags(const StreamLags& lags, const std::vector<std::string>& without) {
  EffectSizes named;
  double wheels = lags.wheels.value_or(0.0);
  double gyro = lags.gyro.value_or(0.0);
  // Steering shares the clock of the wheels unless it has a lag of its own.
  double steering = lags.steering.value_or(wheels);
  const bool alike = wheels != 0.0 && gyro != 0.0 && std::abs(wheels - gyro) < kLagsAlike;
  if (alike && std::find(without.begin(), without.end(), "cam.latency") == without.end()) {
    const double of_poses = 0.5 * (wheels + gyro);
    named["cam.latency"] = -of_poses;
    wheels = gyro = 0.0;
    steering -= of_poses;
  }
  if (wheels != 0.0) named["wheels0.latency"] = wheels;
  if (gyro != 0.0) named["imu0.latency"] = gyro;
  if (std::abs(steering - wheels) >= kLagsAlike) named["steering0.latency"] = steering - wheels;
  return named;
}

Observations covered_by_poses(Observations obs, const EffectSizes& effects) {
  if (obs.poses.empty()) return obs;
  const MotionEffects at = motion_effects_of(effects);
  const RowTimes times = row_times(obs, at);
  Observations thick = obs;
  thick.wheels = obs.wheel_readings;
  const RowTimes thick_times = row_times(thick, at);
  // The trajectory is valid for two knots beyond the poses.
  const double begin = times.poses.front() - 2.0 * obs.step_s;
  const double end = times.poses.back() + 2.0 * obs.step_s;
  const auto keep = [&](auto& readings, const std::vector<double>& first,
                        const std::vector<double>& last) {
    const auto from = std::lower_bound(first.begin(), first.end(), begin) - first.begin();
    const auto to = std::upper_bound(last.begin(), last.end(), end) - last.begin();
    readings.erase(readings.begin() + std::max(from, to), readings.end());
    readings.erase(readings.begin(), readings.begin() + from);
  };
  keep(obs.wheels, times.wheels, times.wheels);
  keep(obs.wheel_readings, thick_times.wheels, thick_times.wheels);
  keep(obs.steering, times.steering_begin, times.steering_end);
  keep(obs.gyro, times.gyro_begin, times.gyro_end);
  return obs;
}

}  // namespace roadbook
