#include "diagnosis/streams/stream_faults.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <utility>

#include "base/error.hpp"
#include "base/median.hpp"
#include "diagnosis/streams/lag_by_correlation.hpp"

namespace roadbook {
namespace {

[[noreturn]] void refuse_stamps(const std::string& name,
                                const std::string& stream,
                                const std::string& got,
                                const std::string& want) {
  throw BadInput({Severity::kError, name, 0, stream + " stamps", got, want});
}

std::string seconds_text(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string metres_text(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

// Time span and interval of a stream's stamps.
struct StampSpan {
  double from_s = 0.0;
  double to_s = 0.0;
  double interval_s = 0.0;  // median
};

template <typename Sample>
StampSpan span_of(const std::vector<Sample>& samples) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < samples.size(); ++i)
    steps.push_back(samples[i].t_s - samples[i - 1].t_s);
  return {samples.front().t_s, samples.back().t_s, steps.empty() ? 0.0 : median(std::move(steps))};
}

std::string range_text(const StampSpan& span) {
  return seconds_text(span.from_s) + " to " + seconds_text(span.to_s) + " s";
}

void check_interval(const StampSpan& span,
                    const std::string& name,
                    const std::string& stream,
                    double most_s) {
  constexpr double kLeast = 1e-4;  // [s]
  if (span.interval_s == 0.0 || (span.interval_s >= kLeast && span.interval_s <= most_s)) return;
  refuse_stamps(name, stream, "a reading every " + seconds_text(span.interval_s) + " s",
                "every " + seconds_text(kLeast) + " to " + seconds_text(most_s) +
                    " s (check the unit of the stamps)");
}

template <typename Sample>
void check_span(const std::vector<Sample>& samples,
                const StampSpan& poses,
                const std::string& name,
                const std::string& stream,
                double min_common_s) {
  constexpr double kRarest = 2.0;  // [s]; the motion of a car is correlated over about 1 s
  if (samples.empty()) return;
  const StampSpan span = span_of(samples);
  check_interval(span, name, stream, kRarest);
  const double common = std::min(span.to_s, poses.to_s) - std::max(span.from_s, poses.from_s);
  if (common < min_common_s)
    refuse_stamps(name, stream, range_text(span),
                  "at least " + seconds_text(min_common_s) + " s in common with the poses (" +
                      range_text(poses) + "); check the clock and the unit of the stamps");
}

// Largest distance of the poses in [from, to] from their first position.
double farthest_of_poses(const std::vector<PoseSample>& poses, double from, double to) {
  const auto first = std::lower_bound(poses.begin(), poses.end(), from,
                                      [](const PoseSample& p, double t) { return p.t_s < t; });
  double farthest = 0.0;
  for (auto p = first; p != poses.end() && p->t_s <= to; ++p)
    farthest = std::max(farthest, std::hypot(p->x - first->x, p->y - first->y));
  return farthest;
}

// Distance driven in [from, to]: the sum over the farthest point of each third; 0 if they stand in
// any third, because a jump of the receiver is no driving.
double driven_in(const std::vector<PoseSample>& poses, double from, double to) {
  constexpr double kLeastSpeed = 0.5;  // [m/s]
  constexpr double kLeastWay = 1.0;    // [m]
  const double third = (to - from) / 3.0;
  double way = 0.0;
  for (int k = 0; k < 3; ++k) {
    const double part = farthest_of_poses(poses, from + k * third, from + (k + 1) * third);
    if (part < std::max(kLeastWay, kLeastSpeed * third)) return 0.0;
    way += part;
  }
  return way;
}

// Smallest distance driven in [from, to] for any clock offset that a search may find.
double surely_driven(const std::vector<PoseSample>& poses, double from, double to) {
  constexpr int kShifts = 20;
  double least = 1e300;
  for (int i = -kShifts; i <= kShifts && least > 0.0; ++i) {
    const double shift = kFarthestLag * i / kShifts;
    least = std::min(least, driven_in(poses, from + shift, to + shift));
  }
  return least;
}

std::string stuck_wheel(const MotionStreams& s, double WheelSample::*angle, const char* side) {
  constexpr double kLeastDriven = 5.0;  // [m] displacement of poses without a standstill
  const auto& w = s.wheels;
  for (std::size_t i = 0; i < w.size();) {
    std::size_t end = i + 1;
    while (end < w.size() && w[end].*angle == w[i].*angle) ++end;
    const double from = w[i].t_s;
    const double to = w[end - 1].t_s;
    const bool always = i == 0 && end == w.size();
    const double way = always ? farthest_of_poses(s.poses, s.poses.front().t_s, s.poses.back().t_s)
                              : surely_driven(s.poses, from, to);
    if (way >= (always ? kLeastDriven : 1e-9)) {
      return "data fault: wheels0 (" + std::string(side) + ") stands still from " +
             metres_text(from) + " to " + metres_text(to) + " s while the car drives at least " +
             metres_text(way) +
             " m: a stuck encoder, a blocked wheel or the wrong column; wheels0 is left out";
    }
    i = end;
  }
  return {};
}

// True if the turn of the poses is not proportional to `progress` (distance or time between two
// poses). A reading that never changes is then stuck.
bool turns_vary(const std::vector<PoseSample>& poses,
                const std::function<double(const PoseSample&, const PoseSample&)>& progress) {
  constexpr double kTurned = 1.0;  // [rad]
  std::vector<std::pair<double, double>> chunks;
  std::size_t last = 0;
  double turn = 0.0, on = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    if (poses[i].t_s - poses[last].t_s < 1.0) continue;
    chunks.emplace_back(
        std::remainder(poses[i].heading - poses[last].heading, 2.0 * std::numbers::pi),
        progress(poses[last], poses[i]));
    turn += chunks.back().first;
    on += chunks.back().second;
    last = i;
  }
  double whole = 0.0, beside = 0.0;
  for (const auto& [turned, went] : chunks) {
    whole += std::abs(turned);
    beside += std::abs(turned - (on > 0.0 ? turn / on : 0.0) * went);
  }
  return beside > kTurned && beside > 0.5 * whole;
}

template <typename Sample>
bool never_changes(const std::vector<Sample>& samples, double Sample::*value) {
  return samples.size() > 1 && std::all_of(samples.begin(), samples.end(), [&](const Sample& s) {
           return s.*value == samples.front().*value;
         });
}

std::string frozen(const std::string& stream, double value, const char* unit) {
  return "data fault: " + stream + " reads " + seconds_text(value) + " " + unit +
         " at all times although the turn rate of the car varies: a stuck sensor or the wrong "
         "column; " +
         stream + " is left out";
}

}  // namespace

void check_stamps(const MotionStreams& s, const std::string& name, double min_common_s) {
  constexpr double kRarestPoses = 10.0;  // [s]
  const StampSpan poses = span_of(s.poses);
  check_interval(poses, name, "poses", kRarestPoses);
  check_span(s.wheels, poses, name, "wheels0", min_common_s);
  check_span(s.steering, poses, name, "steering0", min_common_s);
  check_span(s.gyro, poses, name, "imu0", min_common_s);
}

void check_offsets(const Observations& obs, const Trajectory& motion, const std::string& name) {
  const StreamLags far = far_lags(obs, motion);
  const auto check = [&](const std::optional<double>& lag, const char* stream) {
    if (!lag) return;
    refuse_stamps(name, stream,
                  "readings " + metres_text(std::abs(*lag)) + " s " +
                      (*lag > 0.0 ? "behind" : "ahead of") + " the motion of the poses",
                  "clocks within " + seconds_text(kFarthestLag) + " s of each other");
  };
  check(far.wheels, "wheels0");
  check(far.steering, "steering0");
  check(far.gyro, "imu0");
}

std::vector<std::string> drop_stuck(MotionStreams& s) {
  std::vector<std::string> lines;
  const auto time = [](const PoseSample& a, const PoseSample& b) { return b.t_s - a.t_s; };
  const auto way = [](const PoseSample& a, const PoseSample& b) {
    return std::hypot(b.x - a.x, b.y - a.y);
  };
  const bool both = s.wheels_read == WheelsRead::kBoth;
  std::string stuck = stuck_wheel(s, &WheelSample::left_rad, both ? "left" : "the one read");
  if (stuck.empty() && both) stuck = stuck_wheel(s, &WheelSample::right_rad, "right");
  if (!stuck.empty()) {
    lines.push_back(stuck);
    s.wheels.clear();
  }
  if (never_changes(s.steering, &SteeringSample::angle_rad) && turns_vary(s.poses, way)) {
    lines.push_back(frozen("steering0", s.steering.front().angle_rad, "rad"));
    s.steering.clear();
  }
  if (never_changes(s.gyro, &GyroSample::rate_rad_s) && turns_vary(s.poses, time)) {
    lines.push_back(frozen("imu0", s.gyro.front().rate_rad_s, "rad/s"));
    s.gyro.clear();
  }
  return lines;
}

}  // namespace roadbook
