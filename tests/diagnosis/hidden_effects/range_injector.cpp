#include "tests/diagnosis/hidden_effects/range_injector.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/random.hpp"
#include "drive/writer.hpp"
#include "tests/diagnosis/hidden_effects/noise_source.hpp"

namespace roadbook::test {
namespace {

constexpr double kPi = std::numbers::pi;

struct Edge {
  double ax, ay, bx, by;
};

// Walls of a hall of 36 x 24 m, four pillars in the middle, cars along the walls.
std::vector<Edge> hall(Random random) {
  std::vector<Edge> edges;
  const auto box = [&](double x, double y, double length, double width, double heading) {
    const double c = std::cos(heading), s = std::sin(heading);
    double px[4], py[4];
    for (int i = 0; i < 4; ++i) {
      const double u = (i == 0 || i == 3 ? -0.5 : 0.5) * length;
      const double v = (i < 2 ? -0.5 : 0.5) * width;
      px[i] = x + c * u - s * v;
      py[i] = y + s * u + c * v;
    }
    for (int i = 0; i < 4; ++i) edges.push_back({px[i], py[i], px[(i + 1) % 4], py[(i + 1) % 4]});
  };
  box(18.0, 12.0, 36.0, 24.0, 0.0);
  for (int i = 0; i < 4; ++i) box(11.0 + 4.6 * i, 12.0, 0.5, 0.5, 0.0);
  for (int side = 0; side < 2; ++side)
    for (int i = 0; i < 12; ++i)
      if (random.uniform() < 0.5)
        box(3.5 + 2.6 * i + random.uniform(-0.2, 0.2), side == 0 ? 2.7 : 21.3,
            random.uniform(4.0, 4.7), random.uniform(1.7, 1.9),
            kPi / 2.0 + random.uniform(-0.05, 0.05));
  return edges;
}

double nearest(const std::vector<Edge>& edges, double x, double y, double angle) {
  const double dx = std::cos(angle), dy = std::sin(angle);
  double best = 1e9;
  for (const Edge& e : edges) {
    const double ex = e.bx - e.ax, ey = e.by - e.ay;
    const double cross = dx * ey - dy * ex;
    if (std::abs(cross) < 1e-12) continue;
    const double wx = e.ax - x, wy = e.ay - y;
    const double along = (wx * ey - wy * ex) / cross;
    const double on = (wx * dy - wy * dx) / cross;
    if (along > 0.0 && on >= 0.0 && on <= 1.0) best = std::min(best, along);
  }
  return best;
}

struct Pose {
  double x, y, heading;
};

// A rounded rectangle between the cars, 7 m from the long walls.
Pose on_lap(double s) {
  constexpr double kStraight = 20.0, kShort = 2.0, kRadius = 4.0;
  const double bend = 0.5 * kPi * kRadius;
  const double half = kStraight + bend + kShort + bend;
  double u = std::fmod(s, 2.0 * half);
  const bool back = u >= half;
  if (back) u -= half;
  Pose p{};
  if (u < kStraight) {
    p = {-0.5 * kStraight + u, -kRadius - 0.5 * kShort, 0.0};
  } else if (u < kStraight + bend) {
    const double a = (u - kStraight) / kRadius;
    p = {0.5 * kStraight + kRadius * std::sin(a), -0.5 * kShort - kRadius * std::cos(a), a};
  } else if (u < kStraight + bend + kShort) {
    p = {0.5 * kStraight + kRadius, -0.5 * kShort + u - kStraight - bend, 0.5 * kPi};
  } else {
    const double a = (u - kStraight - bend - kShort) / kRadius;
    p = {0.5 * kStraight + kRadius * std::cos(a), 0.5 * kShort + kRadius * std::sin(a),
         0.5 * kPi + a};
  }
  if (back) p = {-p.x, -p.y, p.heading + kPi};
  return {18.0 + p.x, 12.0 + p.y, p.heading};
}

// Speed in car parks: 1.5 to 2.5 m/s, varying in waves.
class Speed {
 public:
  explicit Speed(std::uint64_t seed) {
    Random random(seed, "scanner's speed");
    mean_ = random.uniform(1.5, 2.5);
    for (Wave& w : waves_)
      w = {random.uniform(0.15, 0.3) * mean_, 2.0 * kPi / random.uniform(6.0, 25.0),
           random.uniform(0.0, 2.0 * kPi)};
  }
  [[nodiscard]] double at(double t) const {
    double v = mean_;
    for (const Wave& w : waves_) v += w.size * std::sin(w.rate * t + w.phase);
    return v;
  }

 private:
  struct Wave {
    double size, rate, phase;
  };
  double mean_ = 2.0;
  std::array<Wave, 2> waves_{};
};

// A reading at distance `z`: a draw from the four parts of the beam model by rejection, independent
// of the simulator's inversion. `off`: noise of a hit.
double say(double z, double off, double max_m, double rate, const Secret& secret, Random& random) {
  const double u = random.uniform();
  const double maximum = of(secret, "range0.maximum");
  const double crosstalk = of(secret, "range0.crosstalk");
  const double shorter = of(secret, "range0.short");
  if (u < maximum) return max_m;
  if (u < maximum + crosstalk) return random.uniform(0.0, max_m);
  if (u < maximum + crosstalk + shorter) {
    double r = 0.0;
    do r = -std::log(1.0 - random.uniform()) / rate;
    while (r > std::min(z, max_m));
    return r;
  }
  if (z >= max_m) return max_m;
  return std::clamp(z + off, 0.0, max_m);
}

}  // namespace

void write_range_drive(const RangeSecret& hidden, const std::filesystem::path& folder) {
  const std::vector<Edge> edges = hall(Random(hidden.seed, "hall"));
  Random random(hidden.seed, "scanner");
  const double sigma = random.uniform(0.015, 0.03);
  const double rate = random.uniform(0.3, 1.2);
  RangeModel model;
  model.max_m = random.uniform(12.0, 20.0);
  model.sigma_m = 0.02;
  model.azimuth_rad.clear();
  for (int b = -15; b <= 15; ++b) model.azimuth_rad.push_back(b * 7.0 * kPi / 180.0);
  model.T_vehicle_sensor.translation() = Eigen::Vector3d(2.0, 0.0, 0.5);
  DriveWriterOptions options;
  options.overwrite = true;
  DriveWriter writer(folder, {}, std::nullopt, options);
  writer.set_range_model(model);
  std::vector<TimedPose> poses;
  const double length = 2.0 * (22.0 + 4.0 * kPi) * hidden.laps;
  const Speed speed(hidden.seed);
  HiddenDriveOptions noise_options;
  noise_options.seed = hidden.seed;
  noise_options.secret = hidden.secret;
  std::vector<NoiseSource> noise;
  for (std::size_t b = 0; b < model.azimuth_rad.size(); ++b)
    noise.emplace_back(noise_options, "range0", b);
  double s = 0.0;
  const double lag = random.uniform(0.0, 2.0 * 22.0);
  double last_heading = on_lap(lag).heading;
  for (int k = 0; s < length; ++k) {
    const double t = 0.1 * k;
    const std::int64_t t_ns = stamp(t);
    const Pose p = on_lap(lag + s);
    Moment now;
    now.speed = speed.at(t);
    now.yaw_rate = std::remainder(p.heading - last_heading, 2.0 * kPi) / 0.1;
    last_heading = p.heading;
    s += 0.1 * now.speed;
    const double x = p.x + 2.0 * std::cos(p.heading), y = p.y + 2.0 * std::sin(p.heading);
    for (std::size_t b = 0; b < model.azimuth_rad.size(); ++b) {
      const double z = nearest(edges, x, y, p.heading + model.azimuth_rad[b]);
      writer.write_range(
          {t_ns, static_cast<std::int64_t>(b),
           say(z, sigma * noise[b].next(now), model.max_m, rate, hidden.secret, random)});
    }
    TimedPose pose;
    pose.t_ns = t_ns;
    pose.T_world_vehicle =
        Eigen::Translation3d(p.x + 0.01 * random.normal(), p.y + 0.01 * random.normal(), 0.0) *
        Eigen::AngleAxisd(p.heading + 0.001 * random.normal(), Eigen::Vector3d::UnitZ());
    poses.push_back(pose);
  }
  writer.write_truth(poses);
  writer.finish();
}

const std::vector<EffectRange>& range_ranges() {
  static const std::vector<EffectRange> kRanges{
      {"range0.short", 0.01, 0.2, true},          {"range0.maximum", 0.01, 0.1, true},
      {"range0.crosstalk", 0.01, 0.1, true},      {"range0.outliers", 0.01, 0.1, true},
      {"range0.variance(speed)", 0.2, 0.8, true}, {"range0.variance(turn)", 2.0, 8.0, true},
      {"range0.correlation", 0.2, 0.9, true},
  };
  return kRanges;
}

}  // namespace roadbook::test
