#include "diagnosis/streams/level_motion.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/numerics/white_scatter.hpp"

namespace roadbook {
namespace {

constexpr double kLevel = 0.01;  // [rad]
constexpr double kNoRoad = 0.6;  // [rad]

// The attitude at a time, and how fast the slope grows.
struct Tilt {
  double slope = 0.0;
  double bank = 0.0;
  double slope_rate = 0.0;  // [rad/s]
};

class AttitudeAt {
 public:
  explicit AttitudeAt(const std::vector<Attitude>& all) : all_(all) {}

  // Cheapest for times that ascend.
  Tilt operator()(double t_s) {
    if (t_s <= all_.front().t_s) return {all_.front().slope_rad, all_.front().bank_rad, 0.0};
    if (t_s >= all_.back().t_s) return {all_.back().slope_rad, all_.back().bank_rad, 0.0};
    if (t_s < all_[next_].t_s) next_ = 0;
    while (all_[next_ + 1].t_s < t_s) ++next_;
    const Attitude& a = all_[next_];
    const Attitude& b = all_[next_ + 1];
    const double share = (t_s - a.t_s) / (b.t_s - a.t_s);
    return {(1.0 - share) * a.slope_rad + share * b.slope_rad,
            (1.0 - share) * a.bank_rad + share * b.bank_rad,
            (b.slope_rad - a.slope_rad) / (b.t_s - a.t_s)};
  }

 private:
  const std::vector<Attitude>& all_;
  std::size_t next_ = 0;
};

// From the rate about the car's own axis alone; the pitching follows from the slope.
double heading_rate(const Tilt& s, double about_z) {
  return (about_z - std::sin(s.bank) * s.slope_rate) / (std::cos(s.slope) * std::cos(s.bank));
}

// From the rates about two of the car's axes.
double heading_rate(const Tilt& s, double about_z, double about_y) {
  return (std::cos(s.bank) * about_z + std::sin(s.bank) * about_y) / std::cos(s.slope);
}

void level_wheels(const std::vector<Attitude>& attitudes, MotionStreams& streams) {
  const WheelModel& model = streams.wheel_model;
  AttitudeAt tilt_at(attitudes);
  double left = 0.0, right = 0.0;
  WheelSample before;
  for (std::size_t i = 0; i < streams.wheels.size(); ++i) {
    const WheelSample read = streams.wheels[i];
    if (i == 0) {
      left = read.left_rad;
      right = read.right_rad;
    } else {
      const double seconds = read.t_s - before.t_s;
      const Tilt s = tilt_at(0.5 * (read.t_s + before.t_s));
      const double left_m = model.radius_left_m * (read.left_rad - before.left_rad);
      const double right_m = model.radius_right_m * (read.right_rad - before.right_rad);
      const double way = 0.5 * (left_m + right_m) * std::cos(s.slope);
      // A single speed contains no turn.
      const double turn =
          streams.wheels_read == WheelsRead::kBoth
              ? seconds * heading_rate(s, (right_m - left_m) / model.track_width_m / seconds)
              : 0.0;
      left += (way - 0.5 * model.track_width_m * turn) / model.radius_left_m;
      right += (way + 0.5 * model.track_width_m * turn) / model.radius_right_m;
    }
    before = read;
    streams.wheels[i].left_rad = left;
    streams.wheels[i].right_rad = right;
  }
}

bool is_tilted(const std::vector<Attitude>& attitudes) {
  const auto beyond = [&](double limit) {
    return std::any_of(attitudes.begin(), attitudes.end(), [&](const Attitude& a) {
      return std::abs(a.slope_rad) > limit || std::abs(a.bank_rad) > limit;
    });
  };
  return beyond(kLevel) && !beyond(kNoRoad);
}

// Length of way [m] over which a line gives the slope: its variance is 12 scatter^2 spacing /
// length^3.
double length_of_lines(const std::vector<double>& heights, double spacing_m) {
  constexpr double kWanted = 0.01;  // [rad]
  constexpr double kShort = 4.0;    // [m]
  constexpr double kLong = 200.0;   // [m]
  const double scatter = white_scatter(heights);
  return std::clamp(std::cbrt(12.0 * scatter * scatter * spacing_m / (kWanted * kWanted)), kShort,
                    kLong);
}

}  // namespace

void level_motion(const std::vector<Attitude>& road,
                  const std::vector<Attitude>& body,
                  const PitchRates& pitch_rates,
                  MotionStreams& streams) {
  if (is_tilted(road)) level_wheels(road, streams);
  if (!is_tilted(body)) return;
  AttitudeAt tilt_at(body);
  const bool three_axes = pitch_rates.size() == streams.gyro.size();
  for (std::size_t i = 0; i < streams.gyro.size(); ++i) {
    GyroSample& gyro = streams.gyro[i];
    const Tilt s = tilt_at(gyro.t_s);
    gyro.rate_rad_s = three_axes ? heading_rate(s, gyro.rate_rad_s, pitch_rates[i].rate_rad_s)
                                 : heading_rate(s, gyro.rate_rad_s);
  }
}

std::vector<Attitude> slopes_of(const std::vector<PoseSample>& poses,
                                const std::vector<double>& heights_m) {
  // From anchor to anchor, so that the scatter of standing or slow poses does not add up.
  constexpr double kAnchor_m = 1.0;
  std::vector<double> way;
  double base = 0.0;
  std::size_t anchor = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double d = std::hypot(poses[i].x - poses[anchor].x, poses[i].y - poses[anchor].y);
    way.push_back(base + d);
    if (d < kAnchor_m) continue;
    base += d;
    anchor = i;
  }
  if (poses.empty()) return {};
  const double over_m = length_of_lines(
      heights_m, way.back() / static_cast<double>(std::max<std::size_t>(poses.size(), 2)));
  std::vector<Attitude> slopes;
  std::size_t begin = 0, end = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    while (way[i] - way[begin] > 0.5 * over_m) ++begin;
    while (end < poses.size() && way[end] - way[i] <= 0.5 * over_m) ++end;
    double n = 0.0, s = 0.0, ss = 0.0, z = 0.0, sz = 0.0;
    // While the car is at rest there are many poses in one place. Some of them are enough.
    const std::size_t stride = 1 + (end - begin) / 500;
    for (std::size_t k = begin; k < end; k += stride) {
      const double d = way[k] - way[i];
      n += 1.0;
      s += d;
      ss += d * d;
      z += heights_m[k];
      sz += d * heights_m[k];
    }
    const double spread = n * ss - s * s;
    slopes.push_back(
        {poses[i].t_s, spread > 1e-9 * n * n ? std::atan((n * sz - s * z) / spread) : 0.0, 0.0});
  }
  return slopes;
}

}  // namespace roadbook
