#include "tests/diagnosis/hidden_effects/column_injector.hpp"

#include <cmath>
#include <fstream>
#include <iomanip>
#include <memory>
#include <numbers>

#include "base/random.hpp"

namespace roadbook::test {
namespace {

// Sum of waves with periods of 8 to 80 s: slow changes by load, sun and cooling.
std::function<double(double)> waves(std::uint64_t seed, const std::string& name) {
  struct Wave {
    double amplitude, rate, phase;
  };
  Random random(seed, "waves " + name);
  std::vector<Wave> all;
  double square = 0.0;
  for (int i = 0; i < 5; ++i) {
    const double period = 8.0 * std::pow(10.0, random.uniform());
    all.push_back({random.normal(), 2.0 * std::numbers::pi / period,
                   random.uniform(0.0, 2.0 * std::numbers::pi)});
    square += 0.5 * all.back().amplitude * all.back().amplitude;
  }
  const double scale = 1.0 / std::sqrt(square);
  return [all, scale](double t) {
    double sum = 0.0;
    for (const Wave& w : all) sum += w.amplitude * std::sin(w.rate * t + w.phase);
    return scale * sum;
  };
}

// Random steps between four values, each held for 3 to 15 s.
std::function<double(double)> steps(std::uint64_t seed) {
  auto ends = std::make_shared<std::vector<double>>();
  auto values = std::make_shared<std::vector<double>>();
  Random random(seed, "steps");
  for (double t = 0.0; t < 2000.0;) {
    t += random.uniform(3.0, 15.0);
    ends->push_back(t);
    values->push_back(static_cast<double>(random.below(4)) - 1.5);
  }
  return [ends, values](double t) {
    const auto after = std::upper_bound(ends->begin(), ends->end(), t);
    return (*values)[static_cast<std::size_t>(after - ends->begin())] / std::sqrt(1.25);
  };
}

double seconds(const Recording& r, std::int64_t t_ns) {
  return 1e-9 * static_cast<double>(t_ns - r.poses.front().t_ns);
}

class Table {
 public:
  Table(const std::filesystem::path& file, const std::string& header) : out_(file) {
    out_ << header << '\n' << std::setprecision(12);
  }
  void row(const std::vector<double>& values) {
    for (std::size_t i = 0; i < values.size(); ++i) out_ << (i > 0 ? "," : "") << values[i];
    out_ << '\n';
  }

 private:
  std::ofstream out_;
};

void write_signal(const CarSignal& signal, double end_s, const std::filesystem::path& folder) {
  Table table(folder / (signal.name + ".csv"), "t,value");
  for (double t = 0.0; t <= end_s; t += signal.period_s) {
    double value = signal.mean + signal.spread * signal.of(t);
    if (signal.resolution > 0.0) value = signal.resolution * std::round(value / signal.resolution);
    table.row({t, value});
  }
}

}  // namespace

std::vector<CarSignal> draw_signals(std::uint64_t seed) {
  return {
      {"battery_voltage", "V", 0.1, 0.01, 13.2, 0.4, waves(seed, "battery")},
      {"tyre_temperature", "degC", 1.0, 0.1, 38.0, 3.0, waves(seed, "tyre")},
      {"gear", "", 0.1, 0.0, 2.5, std::sqrt(1.25), steps(seed)},
  };
}

const std::vector<ColumnEffect>& column_effects() {
  static const std::vector<ColumnEffect> kEffects{
      {{"outside.gyro_scale_by_column", 0.006, 0.03}, "imu0.scale"},
      {{"outside.gyro_bias_by_column", 0.0007, 0.005}, "imu0.yaw_rate"},
      {{"outside.wheels_by_column", 0.004, 0.02}, "wheels0.scale"},
  };
  return kEffects;
}

std::filesystem::path write_plain_log(const Recording& recording,
                                      const std::vector<CarSignal>& signals,
                                      const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  Table poses(folder / "poses.csv", "t,x,y,heading");
  for (const TimedPose& p : recording.poses) {
    const Eigen::Matrix3d R = p.T_world_vehicle.linear();
    const Eigen::Vector3d at = p.T_world_vehicle.translation();
    poses.row({seconds(recording, p.t_ns), at.x(), at.y(), std::atan2(R(1, 0), R(0, 0))});
  }
  Table wheels(folder / "wheels.csv", "t,left,right,steering");
  for (const WheelReading& w : recording.wheels)
    wheels.row({seconds(recording, w.t_ns), w.left_angle_rad, w.right_angle_rad, *w.steering_rad});
  Table gyro(folder / "gyro.csv", "t,rate");
  for (const ImuReading& g : recording.imu)
    gyro.row({seconds(recording, g.t_ns), g.angular_velocity_rad_s.z()});
  const WheelModel& m = recording.wheel_model;
  const auto file = folder / "log.yaml";
  std::ofstream yaml(file);
  yaml << "vehicle: {radius_m: " << m.radius_left_m << ", track_width_m: " << m.track_width_m
       << ", wheelbase_m: " << m.wheelbase_m << ", sigma_angle_rad: " << m.sigma_angle_rad << "}\n"
       << "poses: {file: poses.csv, time: t, x: x, y: y, heading: heading}\n"
       << "wheels: {file: wheels.csv, time: t, left: left, right: right}\n"
       << "steering: {file: wheels.csv, time: t, angle: steering}\n"
       << "gyro: {file: gyro.csv, time: t, rate: rate}\n"
       << "covariates:\n";
  for (const CarSignal& s : signals) {
    write_signal(s, seconds(recording, recording.poses.back().t_ns), folder);
    yaml << "  - {name: " << s.name << ", file: " << s.name << ".csv, time: t, column: value";
    if (!s.unit.empty()) yaml << ", unit: " << s.unit;
    yaml << "}\n";
  }
  return file;
}

}  // namespace roadbook::test
