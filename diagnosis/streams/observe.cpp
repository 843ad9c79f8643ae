#include "diagnosis/streams/observe.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "diagnosis/streams/coarse_readings.hpp"
#include "diagnosis/streams/dead_reckoning.hpp"
#include "diagnosis/streams/wheel_rows.hpp"

namespace roadbook {
namespace {

double unwrapped(double angle, double near) {
  return near + std::remainder(angle - near, 2.0 * std::numbers::pi);
}

// Unwraps the headings of poses. Over a gap, the other streams provide the turn, which may exceed
// half a revolution.
void unwrap_headings(Observations& obs) {
  const double gap = pose_gap_s(obs.poses);
  for (std::size_t i = 1; i < obs.poses.size(); ++i) {
    const PoseSample& before = obs.poses[i - 1];
    PoseSample& pose = obs.poses[i];
    double expected = before.heading;
    if (pose.t_s - before.t_s > gap) expected += reckoned_turn(obs, before.t_s, pose.t_s);
    pose.heading = unwrapped(pose.heading, expected);
  }
}

// Computes residual sums of a window's readings about their regression line.
template <typename Sample, typename Value>
void scatter_about_line(const std::vector<Sample>& samples,
                        std::size_t begin,
                        std::size_t end,
                        const Value& value_of,
                        WindowObservation& window) {
  const auto n = static_cast<double>(end - begin);
  const double first = samples[begin].t_s;
  double st = 0.0, sy = 0.0, stt = 0.0, sty = 0.0;
  for (std::size_t i = begin; i < end; ++i) {
    const double t = samples[i].t_s - first;
    const double y = value_of(samples[i]);
    st += t;
    sy += y;
    stt += t * t;
    sty += t * y;
  }
  const double slope = (sty - st * sy / n) / (stt - st * st / n);
  double before = 0.0;
  for (std::size_t i = begin; i < end; ++i) {
    const double r = value_of(samples[i]) - sy / n - slope * (samples[i].t_s - first - st / n);
    window.squares += r * r;
    if (i > begin) window.lagged += r * before;
    before = r;
  }
}

// Means over windows [k step, (k + 1) step). A window without readings near one of its ends is left
// out, because its mean would belong to another time than its middle.
template <typename Sample, typename Value>
std::vector<WindowObservation> window_means(const std::vector<Sample>& samples,
                                            double from_s,
                                            double to_s,
                                            double step_s,
                                            const Value& value_of) {
  std::vector<WindowObservation> windows;
  const auto window_of = [&](const Sample& s) { return std::floor((s.t_s - from_s) / step_s); };
  for (std::size_t i = 0; i < samples.size();) {
    std::size_t end = i;
    double sum = 0.0;
    for (; end < samples.size() && window_of(samples[end]) == window_of(samples[i]); ++end)
      sum += value_of(samples[end]);
    const std::size_t count = end - i;
    WindowObservation window{samples[i].t_s, samples[end - 1].t_s, sum / static_cast<double>(count),
                             count};
    if (count > 2) scatter_about_line(samples, i, end, value_of, window);
    if (window.begin_s >= from_s && window.end_s <= to_s) windows.push_back(window);
    i = end;
  }
  std::vector<std::size_t> counts;
  for (const auto& w : windows) counts.push_back(w.count);
  if (counts.empty()) return windows;
  const auto middle = counts.begin() + static_cast<std::ptrdiff_t>(counts.size() / 2);
  std::nth_element(counts.begin(), middle, counts.end());
  const std::size_t usual = *middle;
  std::erase_if(windows, [&](const WindowObservation& w) { return w.count + 1 < usual; });
  return windows;
}

template <typename Sample, typename Value>
std::vector<double> stream_values(const std::vector<Sample>& samples, const Value& value_of) {
  std::vector<double> values;
  for (const Sample& s : samples) values.push_back(value_of(s));
  return values;
}

std::vector<WheelObservation> thin_wheels(const MotionStreams& streams,
                                          double from_s,
                                          double to_s,
                                          double step_s) {
  std::vector<WheelObservation> thin;
  for (const WheelSample& s : streams.wheels) {
    if (s.t_s < from_s || s.t_s > to_s) continue;
    // Tolerance of half a microsecond: a reading exactly one step later is kept.
    if (!thin.empty() && s.t_s - thin.back().t_s < step_s - 5e-7) continue;
    const Eigen::Vector2d moved =
        rolled(streams.wheel_model, streams.wheels_read, {s.left_rad, s.right_rad});
    thin.push_back({s.t_s, moved.x(), moved.y(), s.left_rad, s.right_rad});
  }
  return thin;
}

}  // namespace

Observations observe(const MotionStreams& streams, const ObservationOptions& options) {
  Observations obs;
  obs.wheel_model = streams.wheel_model;
  obs.wheels_read = streams.wheels_read;
  obs.poses_have_heading = streams.poses_have_heading;
  obs.poses_of_map = streams.poses_of_map;
  obs.bank_is_known = streams.bank_is_known;
  obs.step_s = options.step_s;
  obs.poses = streams.poses;
  if (obs.poses.empty()) return obs;
  const double from = obs.poses.front().t_s;
  const double to = obs.poses.back().t_s;
  obs.origin_s = from;
  obs.wheels = thin_wheels(streams, from, to, options.step_s);
  obs.wheel_readings = thin_wheels(streams, from, to, 0.0);
  const auto angle = [](const SteeringSample& s) { return s.angle_rad; };
  const auto rate = [](const GyroSample& s) { return s.rate_rad_s; };
  obs.steering = window_means(streams.steering, from, to, options.step_s, angle);
  obs.gyro = window_means(streams.gyro, from, to, options.step_s, rate);
  obs.steering_step_rad = coarse_step(stream_values(streams.steering, angle), obs.steering);
  obs.gyro_step_rad_s = coarse_step(stream_values(streams.gyro, rate), obs.gyro);
  obs.columns = column_covariates(streams.columns, from, to);
  unwrap_headings(obs);
  return obs;
}

}  // namespace roadbook
