#include "tests/diagnosis/hidden_effects/friction_injector.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/random.hpp"
#include "drive/writer.hpp"
#include "tests/diagnosis/hidden_effects/closed_road.hpp"
#include "tests/diagnosis/hidden_effects/noise_source.hpp"

namespace roadbook::test {
namespace {

constexpr double kTickS = 0.02;

struct Now {
  double t, s, x, y, heading, speed, acceleration, yaw_rate, temperature;
};

// Speed limit of one lap in bins of kBin metres: lateral acceleration in bends, and stops to give
// way at some places with probability one half.
constexpr double kBin = 0.5;
std::vector<double> lap_limits(const ClosedRoad& road,
                               double sideways,
                               double braking,
                               const std::vector<double>& waits,
                               Random& random) {
  const auto n = static_cast<std::size_t>(road.length() / kBin);
  std::vector<double> limit(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double s = kBin * static_cast<double>(i) + road.length();
    const double turned = std::remainder(road.heading(s + 3.0) - road.heading(s - 3.0), kTwoPi);
    limit[i] = std::sqrt(sideways / std::max(std::abs(turned) / 6.0, 1e-4));
  }
  for (const double at : waits)
    if (random.uniform() < 0.5) limit[static_cast<std::size_t>(at / kBin) % n] = 1.5;
  for (std::size_t i = n - 1; i-- > 0;)
    limit[i] = std::min(limit[i], std::sqrt(limit[i + 1] * limit[i + 1] + 2.0 * braking * kBin));
  return limit;
}

// As drivers drive: a cruising speed that strays in slow waves, bends taken with 1.5 to 3 m/s^2
// sideways, braking with 1.5 to 2.5 m/s^2, speeding up with 1 to 2 m/s^2 (as the built-in scenario
// `road`); tyres warm with work.
std::vector<Now> drive_laps(const ClosedRoad& road, const FrictionSecret& o) {
  Random random(o.seed, "laps");
  const double cruise = random.uniform(9.0, 14.0);
  const double sideways = random.uniform(1.5, 3.0), braking = random.uniform(1.5, 2.5),
               pushing = random.uniform(1.0, 2.0);
  std::array<double, 4> size{}, rate{}, phase{};
  for (std::size_t k = 0; k < size.size(); ++k) {
    size[k] = random.uniform(0.3, 0.8);
    rate[k] = kTwoPi / random.uniform(10.0, 60.0);
    phase[k] = random.uniform(0.0, kTwoPi);
  }
  const std::vector<double> waits{random.uniform(0.1, 0.45) * road.length(),
                                  random.uniform(0.55, 0.9) * road.length()};
  const double air = random.uniform(0.0, 20.0);
  const double trend = random.uniform(-4.0, 4.0) / o.duration_s;
  double temperature = air;
  double s = 0.0;
  double last_heading = road.heading(0.0);
  double last_speed = 5.0;
  std::vector<Now> all;
  std::vector<double> limits;
  int lap = -1;
  for (int k = 0; kTickS * k <= o.duration_s; ++k) {
    const double t = kTickS * k;
    if (const int now = static_cast<int>(s / road.length()); now != lap) {
      lap = now;
      limits = lap_limits(road, sideways, braking, waits, random);
    }
    double wanted = cruise;
    for (std::size_t i = 0; i < size.size(); ++i)
      wanted += size[i] * std::sin(rate[i] * t + phase[i]);
    // Between two bins the limit changes steadily: steps of 0.5 m would be braked for twenty times
    // a second, which no car does and no reference pose shows.
    const double along = std::fmod(s, road.length()) / kBin;
    const auto bin = std::min(static_cast<std::size_t>(along), limits.size() - 1);
    const double part = std::min(along - static_cast<double>(bin), 1.0);
    const double limit = limits[bin] + part * (limits[(bin + 1) % limits.size()] - limits[bin]);
    const double speed = std::min({last_speed + pushing * kTickS, std::max(wanted, 1.5),
                                   std::max(limit, last_speed - 4.0 * kTickS)});
    const Point p = road.at(s);
    const double heading = road.heading(s);
    const double turned = std::remainder(heading - last_heading, kTwoPi);
    const double yaw_rate = k == 0 ? 0.0 : turned / kTickS;
    const double acceleration = k == 0 ? 0.0 : (speed - last_speed) / kTickS;
    const double work = speed * std::hypot(acceleration, speed * yaw_rate);
    temperature += kTickS / 90.0 * (air + trend * t + 1.2 * work - temperature);
    all.push_back({t, s, p.x, p.y, heading, speed, acceleration, yaw_rate, temperature});
    last_heading = heading;
    last_speed = speed;
    s += speed * kTickS;
  }
  return all;
}

// Surfaces along one lap and the effects hidden in places.
class Ground {
 public:
  Ground(const ClosedRoad& road, const FrictionSecret& o) : road_(road), length_(road.length()) {
    Random random(o.seed, "ground");
    friction_ = {0.9 + random.uniform(-0.08, 0.08), 0.55 + random.uniform(-0.08, 0.08),
                 0.4 + random.uniform(-0.08, 0.08)};
    for (int patch = 0; patch < 10; ++patch) {
      const double from = length_ * (patch + random.uniform(0.0, 0.4)) / 10.0;
      patches_.push_back({from, from + random.uniform(10.0, 0.055 * length_), patch % 2 + 1});
    }
    discs_.push_back(drawn_disc(random, 45.0));
    for (Random more(o.seed, "more surfaces");
         discs_.size() < static_cast<std::size_t>(o.resurfaced);) {
      const Disc disc = drawn_disc(more, 25.0);
      const bool apart = std::all_of(discs_.begin(), discs_.end(), [&](const Disc& other) {
        return std::hypot(disc.centre.x - other.centre.x, disc.centre.y - other.centre.y) >
               1.5 * (disc.radius + other.radius);
      });
      if (apart) discs_.push_back(disc);
    }
    const double reach = random.uniform(12.0, 35.0);
    for (std::size_t k = 0; k < kWaves; ++k) {
      // A stationary process on the circle whose spectrum falls as that of exp(-(d/reach)^2).
      const double w = kTwoPi * static_cast<double>(k + 1) / length_ * reach;
      const double size = std::exp(-w * w / 8.0);
      cosine_.push_back(size * random.normal());
      sine_.push_back(size * random.normal());
      power_ += size * size;
    }
  }
  /// 0 road, 1 gravel, 2 water.
  [[nodiscard]] int kind(double s) const {
    const double u = std::fmod(s, length_);
    for (const Patch& p : patches_)
      if (u >= p.from && u < p.to) return p.kind;
    return 0;
  }
  [[nodiscard]] double friction(int kind) const {
    return friction_[static_cast<std::size_t>(kind)];
  }
  [[nodiscard]] bool extra(const Now& now) const {
    return kind(now.s) == 0 && std::any_of(discs_.begin(), discs_.end(), [&](const Disc& d) {
             return std::hypot(now.x - d.centre.x, now.y - d.centre.y) < d.radius;
           });
  }
  /// Unit variance on average over roads.
  [[nodiscard]] double bias(double s) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < kWaves; ++k) {
      const double w = kTwoPi * static_cast<double>(k + 1) / length_ * s;
      sum += cosine_[k] * std::cos(w) + sine_[k] * std::sin(w);
    }
    return sum / std::sqrt(power_);
  }

 private:
  static constexpr std::size_t kWaves = 60;
  struct Patch {
    double from, to;
    int kind;
  };
  struct Disc {
    Point centre;
    double radius;
  };
  // Another surface: within a disc about a place on the road's commonest class.
  Disc drawn_disc(Random& random, double largest_m) const {
    double s = 0.0;
    do s = random.uniform(0.0, length_);
    while (kind(s) != 0);
    return {road_.at(s), random.uniform(15.0, largest_m)};
  }
  const ClosedRoad& road_;
  double length_;
  std::array<double, 3> friction_{};
  std::vector<Patch> patches_;
  std::vector<Disc> discs_;
  std::vector<double> cosine_, sine_;
  double power_ = 0.0;
};

// Noise with the secret's imperfections; covariates about 2 m/s and 0.2 rad/s, as everywhere.
NoiseSource noise_of(const FrictionSecret& o) {
  HiddenDriveOptions options;
  options.seed = o.seed;
  options.secret = o.secret;
  return {options, "friction0", 8};
}

std::vector<FrictionReading> read_friction(const std::vector<Now>& laps,
                                           const Ground& ground,
                                           const FrictionSecret& o) {
  constexpr std::array kLabels{1, 4, 5};
  NoiseSource noise = noise_of(o);
  Random random(o.seed, "labels");
  const double sigma = 0.05 * Random(o.seed, "real sigma").uniform(0.8, 1.2);
  std::vector<FrictionReading> readings;
  for (std::size_t i = 0; i < laps.size(); i += 5) {  // 10 Hz
    const Now& now = laps[i];
    const int kind = ground.kind(now.s);
    double y = ground.friction(kind);
    const double force = std::hypot(now.acceleration, now.speed * now.yaw_rate);
    y += of(o.secret, "friction0.slip_bias") * force / 9.81;
    y += of(o.secret, "friction0.speed_bias") * now.speed;
    if (kind == 2) y += of(o.secret, "friction0.drying") * now.t;
    y += of(o.secret, "friction0.temperature") * (now.temperature - 20.0);
    if (ground.extra(now)) y += of(o.secret, "friction0.extra_class");
    y += of(o.secret, "friction0.spatial_bias") * ground.bias(now.s);
    Moment moment;
    moment.speed = now.speed;
    moment.yaw_rate = now.yaw_rate;
    FrictionReading r;
    r.t_ns = stamp(now.t);
    r.sigma = 0.05;
    r.friction = y + sigma * noise.next(moment);
    const bool wrong = random.uniform() < o.wrong_labels;
    const int shift = wrong ? 1 + static_cast<int>(random.below(2)) : 0;
    if (o.surface) r.surface = kLabels[static_cast<std::size_t>((kind + shift) % 3)];
    if (o.temperature) r.temperature_c = std::round(10.0 * now.temperature) / 10.0;
    readings.push_back(r);
  }
  return readings;
}
}  // namespace

void write_friction_drive(const FrictionSecret& hidden, const std::filesystem::path& folder) {
  const ClosedRoad road{Random(hidden.seed, "road")};
  const std::vector<Now> laps = drive_laps(road, hidden);
  const Ground ground(road, hidden);
  DriveWriterOptions options;
  options.overwrite = true;
  DriveWriter writer(folder, {}, std::nullopt, options);
  for (const FrictionReading& r : read_friction(laps, ground, hidden)) writer.write_friction(r);
  Random random(hidden.seed, "pose noise");
  std::vector<TimedPose> poses;
  for (std::size_t i = 0; i < laps.size(); i += 4) {  // 12.5 Hz
    const Now& now = laps[i];
    TimedPose p;
    p.t_ns = stamp(now.t);
    p.T_world_vehicle =
        Eigen::Translation3d(now.x + 0.02 * random.normal(), now.y + 0.02 * random.normal(), 0.0) *
        Eigen::AngleAxisd(now.heading + 0.0017 * random.normal(), Eigen::Vector3d::UnitZ());
    poses.push_back(p);
  }
  writer.write_truth(poses);
  writer.finish();
}

const std::vector<EffectRange>& friction_ranges() {
  static const std::vector<EffectRange> kRanges{
      {"friction0.slip_bias", 0.03, 0.2},           {"friction0.speed_bias", 0.001, 0.01},
      {"friction0.drying", 2.8e-5, 8.3e-5},         {"friction0.temperature", 0.001, 0.005},
      {"friction0.extra_class", 0.1, 0.3},          {"friction0.spatial_bias", 0.02, 0.08, true},
      {"friction0.outliers", 0.01, 0.1, true},      {"friction0.variance(speed)", 0.1, 0.4, true},
      {"friction0.variance(turn)", 2.0, 8.0, true}, {"friction0.correlation", 0.2, 0.9, true},
  };
  return kRanges;
}

}  // namespace roadbook::test
