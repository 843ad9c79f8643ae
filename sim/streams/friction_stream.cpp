#include "sim/streams/friction_stream.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/gravity.hpp"
#include "base/random.hpp"
#include "sensors/friction.hpp"
#include "sensors/stream_noise.hpp"

namespace roadbook {
namespace {

// A function of place of unit variance whose correlation falls off over 15 m: waves of random
// direction and length (Rahimi and Recht 2007, random Fourier features).
class PlaceBias {
 public:
  explicit PlaceBias(Random random) {
    for (Wave& w : waves_) {
      w.per_m = Eigen::Vector2d(random.normal(), random.normal()) / 15.0;
      w.phase = random.uniform(0.0, 2.0 * std::numbers::pi);
    }
  }
  [[nodiscard]] double at(double x, double y) const {
    double sum = 0.0;
    for (const Wave& w : waves_) sum += std::cos(w.per_m.dot(Eigen::Vector2d(x, y)) + w.phase);
    return sum * std::sqrt(2.0 / static_cast<double>(waves_.size()));
  }

 private:
  struct Wave {
    Eigen::Vector2d per_m;
    double phase = 0.0;
  };
  std::array<Wave, 64> waves_;
};

// Where another surface carries the label of the road: a disc about a place on the way.
struct Disc {
  double x, y, radius_m;
  [[nodiscard]] bool holds(const VehicleState& s) const {
    return std::hypot(s.x - x, s.y - y) < radius_m;
  }
};

Disc resurfaced(const VehicleMotion& drive, Random random) {
  const VehicleState& s = drive.at(random.uniform(0.2, 0.8) * drive.duration_s());
  const double length = drive.states().back().distance_m;
  return {s.x, s.y, std::clamp(0.08 * length, 3.0, 40.0)};
}

// First order: friction heats in proportion to speed and force, the air cools.
class TyreTemperature {
 public:
  [[nodiscard]] double after(double interval_s, double speed, double acceleration) {
    constexpr double kAir = 15.0, kLag = 60.0, kHeat = 1.5;  // [degC], [s], [K s^3/m^2]
    value_ += (kAir + kHeat * speed * acceleration - value_) * interval_s / kLag;
    return value_;
  }

 private:
  double value_ = 15.0;
};

}  // namespace

std::vector<FrictionReading> simulate_friction(const World& world,
                                               const VehicleMotion& drive,
                                               std::int64_t start_ns,
                                               const StreamOptions& options,
                                               bool temperature,
                                               double interval_s) {
  constexpr double kSigma = 0.05;
  const FrictionImperfections<double> off = friction_imperfections(options.effects);
  const PlaceBias bias(Random(options.seed, "friction of places"));
  const Disc extra = resurfaced(drive, Random(options.seed, "resurfaced"));
  Random random(options.seed, "friction");
  StreamNoise noise(options.effects, "friction0");
  TyreTemperature tyres;
  std::vector<FrictionReading> readings;
  for (int k = 0; interval_s * k <= drive.duration_s(); ++k) {
    const VehicleState s = drive.at(interval_s * k);
    const SurfaceClass ground = ground_kind(world, s.x, s.y);
    const double across = s.speed * s.yaw_rate;
    const double horizontal = std::hypot(s.acceleration, across);
    const double tyre_c = tyres.after(interval_s, s.speed, horizontal);
    FrictionMoment at;
    at.in_use = horizontal / kGravity;
    at.speed = s.speed;
    at.elapsed_s = interval_s * k;
    at.above_reference = tyre_c - kFrictionReference;
    at.wet = ground == SurfaceClass::kWater;
    at.extra = ground == SurfaceClass::kRoad && extra.holds(s);
    at.place = bias.at(s.x, s.y);
    FrictionReading reading;
    reading.t_ns = start_ns + static_cast<std::int64_t>(std::llround(interval_s * k * 1e9));
    reading.sigma = kSigma;
    reading.surface = static_cast<int>(ground);
    if (temperature) reading.temperature_c = tyre_c;
    reading.friction = predict_friction(off, friction_of(ground), at);
    if (options.noise) reading.friction += kSigma * noise.next(random, s.speed, s.yaw_rate);
    readings.push_back(reading);
  }
  return readings;
}

}  // namespace roadbook
